//! Checks of coloured noise.

use crate::document::{ColouredNoiseInteraction, NoiseProcess, Problems, Scene};

/// The shortest time of a process, in steps: below it there would be too many jumps in a step.
const LEAST_TIME: f64 = 1.0 / 256.0;

/// Jumps after which the random numbers of a particle begin again.
const MOST_JUMPS: f64 = 2_147_483_648.0;

/// The problems of a coloured noise at a path.
pub(crate) fn check(scene: &Scene, noise: &ColouredNoiseInteraction, path: &str, problems: &mut Problems) {
    let dimension = scene.space.lengths.len();
    if noise.process == NoiseProcess::Literal && dimension != 2 {
        let accepted =
            "\"kangaroo\", \"kangaroo-exponential\" or \"short\": the printed process is one of two dimensions";
        problems.refuse(format!("{path}.process"), format!("\"literal\" in {dimension} dimensions"), accepted);
    }
    let least = LEAST_TIME * scene.time.step;
    if noise.time < least {
        let accepted = format!(
            "at least {least}, a 256th of `time.step`: below it the force jumps hundreds of times within a step, each of \
             them computed, to an effect that is nearly that of white noise; take a smaller `time.step`"
        );
        problems.refuse(format!("{path}.time"), noise.time, accepted);
    } else if scene.time.steps as f64 * scene.time.step / noise.time > MOST_JUMPS {
        let most = (MOST_JUMPS * noise.time / scene.time.step).floor();
        let accepted = format!(
            "at most {most:.0} with this coloured noise: after 2³¹ jumps of a particle its random numbers would begin again"
        );
        problems.refuse("time.steps", scene.time.steps, accepted);
    }
}
