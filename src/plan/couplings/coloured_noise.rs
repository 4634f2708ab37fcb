//! The kernels' part of a coloured noise: modules of its process, their constants, and the buffer of its state.

use crate::model::{ColouredNoise, Model};
use crate::noise::{self, stream};
use crate::scene::NoiseProcess;

/// Bytes of the process of a particle, a [`crate::state::Hold`].
pub(super) const BYTES_PER_PARTICLE: u64 = size_of::<crate::state::Hold>() as u64;

/// The name of the buffer that holds the processes, by particle.
pub(super) const BUFFER: &str = "holds";

/// Largest time that a constant takes, in half steps: above it every hold is as long as can be.
const LONGEST_TIME: f64 = 1e30;

/// The modules that define `advance_hold` and `closing_of_hold`. With a noise they need the module of `control`, that of
/// the dimension and one that defines `pair_words`.
pub(super) fn modules(model: &Model) -> Vec<&'static str> {
    let Some(noise) = &model.coloured_noise else { return vec!["common/holds_off"] };
    let direction = match model.units.dimension {
        1 => "common/direction1",
        2 => "common/direction2",
        _ => "common/direction3",
    };
    let jump = match noise.process {
        NoiseProcess::Kangaroo => "common/jump_kangaroo",
        NoiseProcess::KangarooExponential => "common/jump_kangaroo_exponential",
        NoiseProcess::Short => "common/jump_short",
        NoiseProcess::Literal => "common/jump_literal",
    };
    vec!["common/holds_on", "common/jump_words", direction, jump]
}

/// The constants of those modules.
pub(super) fn constants(model: &Model, noise: &ColouredNoise) -> Vec<(&'static str, f64)> {
    let half_step = 0.5 * model.time_step;
    let key = noise::seed_key(model.seed, stream::JUMP);
    vec![
        ("HOLD_IMPULSE", half_step / model.units.momentum),
        ("HOLD_FORCE", noise.strength.sqrt()),
        ("HOLD_TIME", (noise.time / half_step).min(LONGEST_TIME)),
        ("HOLD_TURNS", 1.0 / (std::f64::consts::TAU * noise.time.sqrt())),
        ("JUMP_STREAM_X", f64::from(key[0])),
        ("JUMP_STREAM_Y", f64::from(key[1])),
    ]
}
