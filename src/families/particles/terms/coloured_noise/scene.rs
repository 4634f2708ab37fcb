//! Coloured noise of a scene.

use super::ColouredNoise;
use crate::document::{ColouredNoiseInteraction, NoiseProcess, Problems, Scene, SpeciesNames, Warning};
use crate::families::particles::combinations::Feature;
use crate::families::particles::terms::SceneTerm;
use crate::families::warnings::warn;
use crate::families::{Model, Particles, Species};

/// The shortest time of a process, in steps: below it there would be too many jumps in a step.
const LEAST_TIME: f64 = 1.0 / 256.0;

/// Jumps after which the random numbers of a particle begin again.
const MOST_JUMPS: f64 = 2_147_483_648.0;

/// Impulses of fewer units of momentum are rounded by more than a thousandth.
const COARSE_IMPULSE: f64 = 500.0;

impl SceneTerm for ColouredNoiseInteraction {
    fn acts(&self) -> bool {
        self.strength > 0.0
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::ColouredNoise, "")]
    }

    fn check(&self, scene: &Scene, _: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        let dimension = scene.space.lengths.len();
        if self.process == NoiseProcess::Literal && dimension != 2 {
            let accepted =
                "\"kangaroo\", \"kangaroo-exponential\" or \"short\": the printed process is one of two dimensions";
            problems.refuse(format!("{path}.process"), format!("\"literal\" in {dimension} dimensions"), accepted);
        }
        let least = LEAST_TIME * scene.time.step;
        if self.time < least {
            let accepted = format!(
                "at least {least}, a 256th of `time.step`: below it the force jumps hundreds of times within a step, each of \
                 them computed, to an effect that is nearly that of white noise; take a smaller `time.step`"
            );
            problems.refuse(format!("{path}.time"), self.time, accepted);
        } else if scene.time.steps as f64 * scene.time.step / self.time > MOST_JUMPS {
            let most = (MOST_JUMPS * self.time / scene.time.step).floor();
            let accepted = format!(
                "at most {most:.0} with this coloured noise: after 2³¹ jumps of a particle its random numbers would begin again"
            );
            problems.refuse("time.steps", scene.time.steps, accepted);
        }
    }

    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        Some(["acts on the same particles again", "one `coloured-noise` interaction"])
    }

    fn is_unsplit(&self, _paired: bool) -> bool {
        true
    }

    fn add(&self, _: &Scene, _: &mut Vec<Species>, particles: &mut Particles) {
        let Self { strength, time, process } = *self;
        particles.coloured_noise = Some(ColouredNoise { strength, time, process });
    }

    /// The momentum that its forces may add up to before friction holds it: the longest time of a kangaroo process
    /// gives 64 times as much. A coarser scale would lose the impulse of half a step in rounding.
    fn random_momenta(&self, time_step: f64) -> [f64; 2] {
        let times = if self.process == NoiseProcess::Short { 16.0 } else { 96.0 };
        let force = self.strength.sqrt();
        [force * (times * self.time).clamp(time_step, 4096.0 * time_step), 0.5 * force * self.time.min(time_step)]
    }

    fn warn(&self, model: &Model, path: &str, warnings: &mut Vec<Warning>) {
        if self.process == NoiseProcess::Literal {
            let message = "the process as it is printed has a mean force that is not zero and that grows with age: it has no \
                           stationary state, and drives the centre of mass; `kangaroo` keeps its holding times without that";
            warn(warnings, format!("{path}.process"), message.to_owned());
        }
        let impulse = 0.5 * self.strength.sqrt() * model.time_step;
        let units = impulse / model.units.momentum;
        if self.strength > 0.0 && units < COARSE_IMPULSE {
            let message = format!(
                "the noise changes a momentum by {impulse:.1e} in half a step, {units:.1} of the units of {:.1e} that momenta \
                 are counted in: rounding distorts it; a larger `time.step` or a lower `temperature` resolves it better",
                model.units.momentum
            );
            warn(warnings, format!("{path}.strength"), message);
        }
    }
}
