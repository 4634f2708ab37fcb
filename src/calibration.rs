//! What is known of the errors of scenes before they run: by theory, where the scheme is solved, or by tradeoffs that were made once and are
//! shipped with the program.

use crate::families::{Checked, ExactMean};
use crate::numbers::three_digits;
use crate::printable;
use crate::scene::{self, Scene};
use crate::tradeoff::{Choice, ChoiceState, Deviation, Measured, Reference, TradeoffSummary, errors_in_words};
use serde_json::Value;
use std::fmt;
use std::sync::LazyLock;

/// Time steps are alike within this factor: errors of a second-order scheme then differ by half of themselves at most.
const ALIKE: f64 = 1.25;

/// Densities are alike within this factor.
const AS_DENSE: f64 = 1.05;

static SUMMARIES: LazyLock<Vec<TradeoffSummary>> =
    LazyLock::new(|| scene::CALIBRATIONS.iter().filter_map(|text| serde_json::from_str(text).ok()).collect());

/// How near what was measured comes to a scene.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Basis {
    /// Theory knows what the scheme gives with the time step.
    Theory,
    /// The same physics with about the same time step.
    Measured,
    /// The same physics with a smaller and a larger time step, between which errors are taken to go with a power of the step.
    Interpolated([f64; 2]),
    /// The same physics with another time step, all of those measured being on the same side of it.
    OtherStep,
    /// Another value of a single choice, as it was measured: `interactions.0.form = gradient`.
    OtherChoice(String),
}

/// Errors that theory knows, or that were measured of a scene of the same physics, with the same integrator.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Title of the scene that was measured, or of that asked about.
    pub scene: String,
    /// The time step that the errors are of.
    pub time_step: f64,
    /// How near that comes to the scene.
    pub basis: Basis,
    /// The errors, measure by measure.
    pub errors: Vec<Deviation>,
    /// When it was measured, as year, month and day; empty where nothing was.
    pub date: String,
    /// The version of the program that measured it, or knows it.
    pub version: String,
}

/// What is said of the errors of a scene that theory knows, of the means that a table of energies has.
const KNOWN: [&str; 5] =
    ["temperature", "configurational_temperature", "potential_energy", "bath_square", "bath_times_displacement"];

/// What was measured of a choice.
struct Known {
    summary: &'static TradeoffSummary,
    choice: &'static Choice,
    scene: Checked,
}

impl Known {
    /// All that was measured and came to its end.
    fn all() -> impl Iterator<Item = Self> {
        let choices = SUMMARIES.iter().flat_map(|summary| summary.choices.iter().map(move |choice| (summary, choice)));
        choices.filter_map(|(summary, choice)| {
            let scene = measured_scene(summary, choice)?;
            Some(Self { summary, choice, scene })
        })
    }

    fn step(&self) -> f64 {
        self.scene.time.step
    }

    fn expected(&self, basis: Basis) -> Expected {
        Expected {
            scene: self.scene.title.clone(),
            time_step: self.choice.time_step,
            basis,
            errors: self.choice.errors.clone(),
            date: self.summary.date.clone(),
            version: self.summary.mesoscope_version.clone(),
        }
    }
}

/// The errors to expect of a scene; none where nothing like it was measured.
///
/// ```
/// use mesoscope::calibration::{self, Basis};
/// use mesoscope::scene;
///
/// let fluid = scene::load("dpd-fluid", &["space.box=[20,20,20]".to_owned()])?;
/// let found = calibration::expected(&fluid).ok_or("it was measured")?;
/// assert!(found.basis == Basis::Measured && found.time_step == fluid.time.step);
/// let other = scene::load("dpd-fluid", &["interactions.0.repulsion=3".to_owned()])?;
/// assert_eq!(calibration::expected(&other), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn expected(scene: &Checked) -> Option<Expected> {
    by_theory(scene).or_else(|| by_measurement(scene))
}

/// The errors of a scheme that is solved.
fn by_theory(scene: &Checked) -> Option<Expected> {
    let model = scene.model();
    let deviation = |mean: ExactMean| {
        let measured = Measured::mean(mean.column.to_owned(), mean.discrete?, Some(0.0), false);
        let exact = Reference::exact(mean.column, mean.continuous, "the mean of the exact motion in equilibrium");
        Some(Deviation::new(&measured, &exact))
    };
    let columns = model.physics().columns(model);
    let is_said =
        |mean: &ExactMean| KNOWN.contains(&mean.column) && columns.iter().any(|column| column.name == mean.column);
    let means = model.physics().exact_means(model).into_iter();
    let errors: Vec<Deviation> = means.filter(is_said).map(deviation).collect::<Option<_>>()?;
    (!errors.is_empty()).then(|| Expected {
        scene: scene.title.clone(),
        time_step: scene.time.step,
        basis: Basis::Theory,
        errors,
        date: String::new(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    })
}

/// The errors of what was measured that is nearest to a scene.
fn by_measurement(scene: &Checked) -> Option<Expected> {
    let nearest = |one: &Known, other: &Known| apart(scene, &one.scene).total_cmp(&apart(scene, &other.scene));
    let (mut alike, others): (Vec<Known>, Vec<Known>) = Known::all()
        .filter(|known| is_like(scene, &known.scene))
        .partition(|known| other_choice(scene, &known.scene).is_none());
    alike.sort_by(nearest);
    if let Some(first) = alike.first() {
        if apart(scene, &first.scene) <= ALIKE {
            return Some(first.expected(Basis::Measured));
        }
        let step = scene.time.step;
        let below = alike.iter().find(|known| known.step() < step);
        let above = alike.iter().find(|known| known.step() > step);
        return Some(match (below, above) {
            (Some(below), Some(above)) => interpolated(step, below, above),
            _ => first.expected(Basis::OtherStep),
        });
    }
    let first = others.into_iter().min_by(nearest)?;
    let choice = other_choice(scene, &first.scene)?;
    Some(first.expected(Basis::OtherChoice(choice)))
}

/// Errors of a step between two that were measured.
fn interpolated(step: f64, below: &Known, above: &Known) -> Expected {
    let ends = [below.step(), above.step()];
    let found = above.expected(Basis::Interpolated(ends));
    let between = |high: &Deviation| {
        let low = below.choice.error(&high.measure).filter(|low| low.relative == high.relative)?;
        let error = between(step, ends, [low.error, high.error]);
        // As uncertain as the less certain of both.
        let uncertainty = low.uncertainty.zip(high.uncertainty).map(|(low, high)| low.max(high));
        let from_few_samples = low.from_few_samples || high.from_few_samples;
        Some(Deviation { error, uncertainty, from_few_samples, of_scheme: None, ..high.clone() })
    };
    let errors = found.errors.iter().filter_map(between).collect();
    Expected { time_step: step, errors, ..found }
}

/// An error between two, by the power of the step that goes through both; by a straight line where they have no common sign, which is that of
/// noise.
fn between(step: f64, [low, high]: [f64; 2], errors: [f64; 2]) -> f64 {
    let part = (step / low).ln() / (high / low).ln();
    let ratio = errors[1] / errors[0];
    if ratio.is_finite() && ratio > 0.0 {
        errors[0] * ratio.powf(part)
    } else {
        errors[0] + (step - low) / (high - low) * (errors[1] - errors[0])
    }
}

/// The scene of a choice that was finished.
fn measured_scene(summary: &TradeoffSummary, choice: &Choice) -> Option<Checked> {
    if choice.state != ChoiceState::Finished {
        return None;
    }
    summary.scene_of(choice).check().ok()
}

/// By what factor time steps differ.
fn apart(one: &Scene, other: &Scene) -> f64 {
    let ratio = one.time.step / other.time.step;
    ratio.max(1.0 / ratio)
}

/// The single choice among those of the interactions that has another name in a scene that was measured: its key and that name.
fn other_choice(scene: &Scene, measured: &Scene) -> Option<String> {
    let [own, known] =
        [scene, measured].map(|scene| serde_json::to_value(&scene.system).unwrap_or_default()["interactions"].take());
    let mut found = Vec::new();
    differences(&own, &known, "interactions", &mut found);
    match &found[..] {
        [(key, Value::String(_), Value::String(name))] => Some(format!("{key} = {name}")),
        _ => None,
    }
}

/// The places at which two values differ, with both.
fn differences<'v>(one: &'v Value, other: &'v Value, key: &str, found: &mut Vec<(String, &'v Value, &'v Value)>) {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) if one.keys().eq(other.keys()) => {
            for (name, value) in one {
                differences(value, &other[name], &format!("{key}.{name}"), found);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            for (place, (one, other)) in one.iter().zip(other).enumerate() {
                differences(one, other, &format!("{key}.{place}"), found);
            }
        }
        _ if one == other => {}
        _ => found.push((key.to_owned(), one, other)),
    }
}

/// Whether two scenes simulate the same physics in the same way but for their time steps, and maybe for the name of a single choice: the same
/// interactions, temperature, integrator and particles in another number, in a box of another size.
fn is_like(one: &Scene, other: &Scene) -> bool {
    let volumes = [one, other].map(|scene| scene.space.volume());
    let groups = || one.particles.iter().zip(&other.particles);
    let as_dense = |(a, b): (&scene::ParticleGroup, &scene::ParticleGroup)| {
        let [a, b] =
            [a.resolved_count(&one.space) as f64 / volumes[0], b.resolved_count(&other.space) as f64 / volumes[1]];
        a.max(b) <= AS_DENSE * a.min(b)
    };
    let alike = |(a, b): (&scene::ParticleGroup, &scene::ParticleGroup)| {
        (a.mass, a.fixed, a.is_frozen(), a.tracer, &a.chain) == (b.mass, b.fixed, b.is_frozen(), b.tracer, &b.chain)
    };
    one.system.particle_integrator() == other.system.particle_integrator()
        && one.system.integrator_name() == other.system.integrator_name()
        && (one.system == other.system || other_choice(one, other).is_some())
        && one.temperature == other.temperature
        && one.space.lengths.len() == other.space.lengths.len()
        && one.space.walls == other.space.walls
        && one.particles.len() == other.particles.len()
        && groups().all(alike)
        && groups().all(as_dense)
}

impl fmt::Display for Expected {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (words, step) = (errors_in_words(&self.errors), three_digits(self.time_step));
        let found = match &self.basis {
            Basis::Theory => return write!(formatter, "{words} off, known exactly for this scheme and step"),
            Basis::Measured => format!("{words} off, as measured with a step of {step}"),
            Basis::Interpolated(ends) => {
                let [low, high] = ends.map(three_digits);
                format!("{words} off, interpolated between steps of {low} and {high} that were measured")
            }
            Basis::OtherStep => {
                format!("not measured at this step; {words} off at a step of {step}, the nearest that was")
            }
            Basis::OtherChoice(choice) => {
                format!("not measured; {words} off with {choice} and a step of {step}, the nearest that was")
            }
        };
        write!(formatter, "{found} ({}, {}, version {})", printable::name(&self.scene), self.date, self.version)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn all_calibrations_can_be_read_and_have_a_date() {
        assert_eq!(SUMMARIES.len(), scene::CALIBRATIONS.len());
        for summary in SUMMARIES.iter() {
            assert!(summary.date.len() == 10 && !summary.choices.is_empty(), "{}", summary.date);
            for choice in summary.choices.iter().filter(|choice| choice.state == ChoiceState::Finished) {
                assert!(measured_scene(summary, choice).is_some(), "{}", choice.name);
            }
        }
    }

    #[test]
    fn only_scenes_of_the_same_physics_are_alike() {
        let scene = |set: &[&str]| {
            let own = ["output={}"].into_iter().chain(set.iter().copied());
            scene::load("dpd-fluid", &own.map(str::to_owned).collect::<Vec<_>>()).unwrap()
        };
        let base = scene(&[]);
        for set in ["space.box=[30,30,30]", "time.steps=9000", "time.step=0.048", "seed=9"] {
            assert!(is_like(&base, &scene(&[set])), "{set}");
        }
        for set in [
            "temperature=0.9",
            "interactions.0.friction=9",
            "integrator.type=groot-warren",
            "particles.0.number_density=4",
            "particles.0.mass=2",
            "space.walls={\"z\":{\"reflection\":\"bounce-back\"}}",
        ] {
            assert!(!is_like(&base, &scene(&[set])), "{set}");
        }
    }

    #[test]
    fn errors_are_those_of_the_step_or_said_to_be_of_others() {
        let at = |step: &str| {
            let set = ["output={}".to_owned(), format!("time.step={step}")];
            expected(&scene::load("dpd-fluid", &set).unwrap()).unwrap()
        };
        let near = at("0.042");
        assert_eq!((near.time_step, near.basis), (0.04, Basis::Measured));
        let outside = at("0.1");
        assert_eq!((outside.time_step, &outside.basis), (0.06, &Basis::OtherStep));
        assert!(outside.to_string().starts_with("not measured at this step; "), "{outside}");
        // Between two steps an error lies between theirs.
        let between = at("0.03");
        assert_eq!(between.basis, Basis::Interpolated([0.02, 0.04]));
        assert!(between.to_string().contains("interpolated between steps of 0.02 and 0.04"), "{between}");
        let error = |found: &Expected| {
            found.errors.iter().find(|e| e.measure == "configurational_temperature").unwrap().clone()
        };
        let [low, middle, high] = [at("0.02"), between, at("0.04")].map(|found| error(&found));
        assert!(
            high.error < middle.error && middle.error < low.error && low.error < 0.0,
            "{low:?} {middle:?} {high:?}"
        );
        assert_eq!(middle.uncertainty, Some(low.uncertainty.unwrap().max(high.uncertainty.unwrap())));
    }

    /// B and W of the shipped oscillators are .01 and .01 with λ = α = K = m = 1, dt = .1 and `exponential`, but for λₑ/λ = tanh(a/2)/(a/2).
    #[test]
    fn theory_knows_schemes_that_are_solved() {
        let load = |set: &[&str]| {
            let set: Vec<String> = set.iter().map(|change| (*change).to_owned()).collect();
            expected(&scene::load("gle-oscillator", &set).unwrap())
        };
        let found = load(&[]).unwrap();
        assert_eq!(found.basis, Basis::Theory);
        let effective = 0.05_f64.tanh() / 0.05;
        let (b, w) = (0.01 * effective, 0.01);
        let margin = 4.0 - b - w;
        for (measure, error) in [
            ("temperature", 0.0),
            ("potential_energy", (4.0 - b) / margin - 1.0),
            ("configurational_temperature", (4.0 - b) / margin - 1.0),
            ("bath_square", effective * (4.0 - w) / margin - 1.0),
            ("bath_times_displacement", b / margin),
        ] {
            let known = found.errors.iter().find(|known| known.measure == measure).unwrap();
            assert!((known.error - error).abs() < 1e-12, "{measure}: {known:?}");
        }
        assert!(found.to_string().ends_with(" off, known exactly for this scheme and step"), "{found}");
        // Repulsion: nothing is known.
        assert_eq!(load(&[r#"interactions.0={"type":"dpd","repulsion":25}"#]), None);
    }

    #[test]
    fn errors_between_two_steps_go_with_a_power_of_the_step() {
        // Of second order: four times the error at twice the step.
        assert!((super::between(0.03, [0.02, 0.04], [0.004, 0.016]) - 0.009).abs() < 1e-12);
        assert!((super::between(0.03, [0.02, 0.04], [-0.004, -0.016]) + 0.009).abs() < 1e-12);
        assert!((super::between(0.03, [0.02, 0.04], [-0.001, 0.003]) - 0.001).abs() < 1e-12);
        assert_eq!(super::between(0.03, [0.02, 0.04], [0.0, 0.0]), 0.0);
    }

    #[test]
    fn shipped_scenes_of_families_that_were_measured_have_something_to_expect() {
        let found = |name: &str| expected(&scene::load(name, &[]).unwrap()).unwrap();
        assert_eq!((found("dpd-fluid").basis, found("shallow-water").basis), (Basis::Measured, Basis::Measured));
        for (name, step) in [("dpd-fluid-2d", 0.04), ("polymer-melt", 0.04), ("edpd-fluid", 0.01)] {
            assert_eq!((found(name).time_step, found(name).basis), (step, Basis::Measured), "{name}");
        }
        let velocity = found("shallow-water").errors.into_iter().find(|error| error.measure == "velocity_distance");
        assert!(velocity.is_some_and(|error| error.uncertainty.is_some_and(|uncertainty| uncertainty > 0.0)));
        let cells = found("voronoi-dpd");
        assert_eq!((cells.time_step, &cells.basis), (0.0005, &Basis::Measured));
        // Forms were measured with two integrators, of which `consistent` has one.
        let consistent = ["interactions.0.form=consistent".to_owned(), "integrator.type=splitting".to_owned()];
        let cells = expected(&scene::load("voronoi-dpd", &consistent).unwrap()).unwrap();
        assert_eq!(
            (cells.time_step, &cells.basis),
            (0.01, &Basis::OtherChoice("interactions.0.form = gradient".to_owned()))
        );
        assert!(cells.to_string().contains("off with interactions.0.form = gradient and a step of 0.01"), "{cells}");
        for name in
            ["langevin-gas", "poiseuille", "couette", "drop", "binary-mixture", "diblock-copolymer", "surfactants"]
        {
            assert_eq!(found(name).basis, Basis::Measured, "{name}");
            assert_eq!(found(name).time_step, scene::load(name, &[]).unwrap().time.step, "{name}");
        }
    }
}
