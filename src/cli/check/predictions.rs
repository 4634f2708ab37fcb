//! What can be said of a run before it: how long its steps may be, how far off its results will be, and what it pays for without need.

use mesoscope::calibration;
use mesoscope::families::{self, BathStep, Beyond, Checked, LargestStep};
use mesoscope::numbers::three_digits;
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::Bath;

/// Reports that take more than this part of the time are worth a word.
const MUCH: f64 = 0.2;

/// A memory of which a step leaves less than this is no memory.
const FORGOTTEN: f64 = 1e-3;

/// How far off results will be, as far as that is known.
pub fn accuracy(source: &str, scene: &Checked) -> String {
    let (step, half) = (three_digits(scene.time.step), three_digits(0.5 * scene.time.step));
    let unknown = || {
        format!(
            "not measured of a scene like this; `mesoscope tradeoff {source} --vary time.step={half},{step}` measures it"
        )
    };
    calibration::expected(scene).map_or_else(unknown, |expected| expected.to_string())
}

/// Rows of the overview.
pub fn rows(source: &str, scene: &Checked, plan: &Plan, hardware: Hardware) -> Vec<(&'static str, String)> {
    let steps = families::largest_steps(scene);
    let largest = |beyond: Beyond| steps.iter().find(|largest| largest.beyond == beyond);
    let words = |largest: &LargestStep| format!("up to {} ({})", three_digits(largest.step), largest.law);
    let mut rows = Vec::new();
    let advisable = largest(Beyond::Biased).map(|largest| format!("advisable {}", words(largest)));
    let stable = largest(Beyond::Unstable).map(|largest| format!("stable by theory {}", words(largest)));
    let both: Vec<String> = [advisable, stable].into_iter().flatten().collect();
    if !both.is_empty() {
        rows.push(("largest step", both.join("; ")));
    }
    if !steps.is_empty() && scene.time.steps > 0 {
        rows.push(("measure", format!("`mesoscope stability {source}` runs it with longer and longer steps")));
    }
    rows.extend(unneeded(scene, plan, hardware).into_iter().map(|what| ("pays for", what)));
    rows
}

/// What takes time and is not needed, or not needed so often.
fn unneeded(scene: &Checked, plan: &Plan, hardware: Hardware) -> Vec<String> {
    let mut found = Vec::new();
    // A report visits everything once more.
    let reports: f64 = plan.samplers.iter().map(|sampler| 1.0 / sampler.every as f64).sum();
    let part = reports / (1.0 + reports);
    if part > MUCH {
        let often = plan.samplers.iter().min_by_key(|sampler| sampler.every).map_or(1, |sampler| sampler.every);
        found.push(format!(
            "reports: about {:.0} % of the time, for samples every {often} steps at the most frequent",
            100.0 * part
        ));
    }
    for (index, interaction) in scene.interactions().iter().enumerate() {
        if let Some((bath, friction)) = interaction.bath()
            && let Bath::Memory { rate, .. } = bath
            && BathStep::of(bath, friction, scene.time.step).persistence.abs() < FORGOTTEN
        {
            let mut without = scene.clone().into_scene();
            if let Some(bath) = without.system.interactions_mut().and_then(|all| all.get_mut(index)?.bath_mut()) {
                *bath = Bath::White { temperature: Some(bath.temperature(scene.temperature)) };
            }
            let own = plan.operations_per_particle;
            let other = without.check_but_step().map(|without| run::plan(&without, hardware, Options::default()));
            let cheaper = match other.map(|other| other.operations_per_particle) {
                Ok(less) if less < own => format!(", which takes {:.0} % less arithmetic", 100.0 * (1.0 - less / own)),
                _ => String::new(),
            };
            found.push(format!(
                "the memory of interactions[{index}]: at a rate of {rate} a step leaves nothing of it, and a bath without memory does the same{cheaper}"
            ));
        }
    }
    found.extend(scene.unneeded());
    let idle = scene.model().species.iter().filter(|species| species.count == 0);
    let idle: Vec<&str> = idle.map(|species| species.name.as_str()).collect();
    if !idle.is_empty() {
        found.push(format!("species without particles: {}", idle.join(", ")));
    }
    found
}
