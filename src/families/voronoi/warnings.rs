//! What is allowed of Voronoi cells but deserves a second look.

use super::time_scales::{FRICTION_LIMIT, RARELY, SOUND_LIMIT, lightest};
use crate::document::shear_waves;
use crate::document::{CellIntegrator, InitialMasses, VoronoiForm, VoronoiInteraction, Warning};
use crate::families::warnings::{warn, warn_of_momentum};
use crate::families::{Beyond, Checked, Limit, Voronoi, speeds};

/// All warnings about a scene.
pub(super) fn warnings(cells: &Voronoi, scene: &Checked) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if let Some(voronoi) = scene.system.voronoi() {
        // A fluid without a temperature is not hot by Euler's scheme either.
        let is_hot = |law: &StepLaw| scene.temperature > 0.0 || law.law != EULER;
        let exceeded = laws(cells, scene, voronoi.form).into_iter().filter(|law| law.share > 1.0 && is_hot(law));
        exceeded.for_each(|law| warn(&mut warnings, "time.step", law.warning));
        warn_of_fluid(scene, voronoi, cells, &mut warnings);
    }
    warn_of_momentum(scene, &mut warnings);
    warnings
}

/// A flow faster than this part of the speed of sound compresses the fluid.
const FLOW_LIMIT: f64 = 0.3;

/// Euler's scheme is hot by about this many times the friction of a step. At density 5, η = 1 and steps of 0.005 and 0.02 in
/// cells of volume 1 it was hot by 1.2 and 6.5 % with the form `gradient`, by 1.8 and 9 % with `paper`.
fn euler_excess(form: VoronoiForm) -> f64 {
    match form {
        VoronoiForm::Paper => 22.0,
        VoronoiForm::Gradient | VoronoiForm::Consistent => 16.0,
    }
}

const EULER: &str = "2 % of heat of Euler's scheme";

/// Excess of the temperature that is worth a warning.
const HOT: f64 = 0.02;

/// A cell of fewer molecules has an internal temperature that noise may take to zero.
const FEWEST_MOLECULES: f64 = 20.0;

/// Reynolds and molecule numbers of a cell up to which the form `paper` keeps the temperature.
const LARGEST_REYNOLDS: f64 = 4.0;

const MOST_MOLECULES: f64 = 20.0;

/// A law that bounds the time step, the part of its bound that a step takes, and what warns of a step that takes more.
struct StepLaw {
    law: &'static str,
    share: f64,
    warning: String,
}

/// The laws that bound the time step.
fn laws(cells: &Voronoi, scene: &Checked, form: VoronoiForm) -> [StepLaw; 3] {
    let (step, lightest) = (scene.time.step, lightest(scene.model()));
    let (sound, size) = (cells.speed_of_sound(speeds::hottest(scene)), Voronoi::mean_volume(scene.model()).sqrt());
    let passed = StepLaw {
        law: "sound through a fifth of a cell",
        share: sound * step / (SOUND_LIMIT * size),
        warning: format!(
            "sound of speed {sound:.3} passes {:.2} of a cell of width {size:.3} in one step of {step}; up to \
             {SOUND_LIMIT}, a step of {:.2e}, is advisable",
            sound * step / size,
            SOUND_LIMIT * size / sound
        ),
    };
    let friction = cells.viscosity * step / lightest;
    let of_friction = if cells.integrator == (CellIntegrator::Euler {}) {
        let excess = euler_excess(form);
        StepLaw {
            law: EULER,
            share: excess * friction / HOT,
            warning: format!(
                "`euler` runs hot by about {:.0} % at this step; {:.1e} would be hot by {:.0} %, and `splitting` takes \
                 this one",
                100.0 * excess * friction,
                HOT / excess * lightest / cells.viscosity,
                100.0 * HOT
            ),
        }
    } else {
        StepLaw {
            law: "friction dt η/M = 1/20",
            share: friction / FRICTION_LIMIT,
            warning: format!(
                "friction of a step, dt η/M, is {friction:.3}; temperatures have been measured up to {FRICTION_LIMIT}, \
                 a step of {:.2e}, and the solver takes more iterations beyond",
                FRICTION_LIMIT * lightest / cells.viscosity
            ),
        }
    };
    let (random, most) = (random_heat(scene, cells).unwrap_or(0.0), cells.exchange_limit);
    let cut = StepLaw {
        law: "conduction cut by its limit",
        share: RARELY * random / most,
        warning: format!(
            "the random heat through a face is {random:.2} of the energy of a cell in one step, and `exchange_limit` \
             {most} will cut it often; a step of {:.2e} or less is advisable",
            step * (most / (RARELY * random)).powi(2)
        ),
    };
    [passed, of_friction, cut]
}

/// The laws that bound the time step, with the parts of their bounds that a step takes.
pub(super) fn limits(cells: &Voronoi, scene: &Checked) -> Vec<Limit> {
    let form = scene.system.voronoi().map(|voronoi| voronoi.form).unwrap_or_default();
    laws(cells, scene, form).map(|StepLaw { law, share, .. }| Limit { law, share, beyond: Beyond::Biased }).into()
}

/// The random heat through a face in one step, as a part of the energy of a cell, where heat is conducted.
fn random_heat(scene: &Checked, cells: &Voronoi) -> Option<f64> {
    let voronoi = scene.system.voronoi()?;
    // Hot cells have fewer molecules at the same pressure.
    let thinned = match voronoi.initial_masses {
        InitialMasses::UniformPressure => voronoi.hottest(scene.temperature) / scene.temperature,
        InitialMasses::Equal | InitialMasses::UniformDensity => 1.0,
    };
    cells.conductivity.map(|_| cells.random_heat(lightest(scene.model()), scene.time.step) * thinned)
}

/// Warns of a fluid of Voronoi cells that the model does not describe well.
fn warn_of_fluid(scene: &Checked, voronoi: &VoronoiInteraction, cells: &Voronoi, warnings: &mut Vec<Warning>) {
    let model = scene.model();
    let path = "interactions[0]";
    let present = || model.species.iter().filter(|species| species.count > 0);
    let mass: f64 = present().map(|species| species.mass * species.count as f64).sum();
    let fewest = present().map(|species| species.mass).fold(f64::INFINITY, f64::min) / cells.molecular_mass;
    let mean = mass / model.particle_count().max(1) as f64 / cells.molecular_mass;
    let reynolds = (mass / model.units.volume() * scene.temperature).sqrt() / cells.viscosity;
    if voronoi.form == VoronoiForm::Paper
        && scene.temperature > 0.0
        && (reynolds > LARGEST_REYNOLDS || mean > MOST_MOLECULES)
    {
        let message = format!(
            "the form `paper` runs hot outside small Reynolds and molecule numbers of a cell, √(ρkT)/η = {reynolds:.2} and \
             M/m = {mean:.0} here: by 25 % at 7.07 and 50, where `gradient` is right"
        );
        warn(warnings, format!("{path}.form"), message);
    }
    if cells.keeps_energy() && fewest < FEWEST_MOLECULES {
        let message = format!(
            "a cell holds {fewest:.0} molecules, and its temperature varies by {:.0} % in equilibrium; {FEWEST_MOLECULES} or \
             more keep its internal energy clear of zero",
            100.0 / fewest.sqrt()
        );
        warn(warnings, format!("{path}.molecular_mass"), message);
    }
    if voronoi.hottest(scene.temperature) == 0.0 {
        let how = if cells.keeps_energy() { "until friction has heated them" } else { "at any time" };
        let message = format!("without a temperature cells have no pressure {how}, and nothing keeps them apart");
        warn(warnings, "temperature", message);
    }
    let coldest = scene.temperature;
    for (index, amplitude, _) in shear_waves(scene) {
        let sound = cells.speed_of_sound(coldest);
        if amplitude.abs() > FLOW_LIMIT * sound {
            let message = format!(
                "the wave is {:.2} times as fast as sound; up to {FLOW_LIMIT} it does not compress the fluid",
                amplitude.abs() / sound
            );
            warn(warnings, format!("particles[{index}].velocities.amplitude"), message);
        }
    }
}
