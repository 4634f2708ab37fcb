//! A random force on every particle that is constant for random times.

use crate::scene::{ColouredNoiseInteraction, NoiseProcess};

/// A random force on every particle that is constant for random times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColouredNoise {
    /// Mean square α of the force.
    pub strength: f64,
    /// Time ε or τ of the process.
    pub time: f64,
    /// The process.
    pub process: NoiseProcess,
}

impl ColouredNoise {
    pub(super) fn new(interaction: &ColouredNoiseInteraction) -> Self {
        Self { strength: interaction.strength, time: interaction.time, process: interaction.process }
    }
}

/// The momentum that forces may add up to before friction holds them: what the longest holding time of a kangaroo process
/// gives is 64 of them. A coarser scale would lose the impulse of half a step in rounding.
pub(super) fn momentum_scale(interaction: &ColouredNoiseInteraction, time_step: f64) -> f64 {
    let holds = match interaction.process {
        NoiseProcess::Kangaroo | NoiseProcess::KangarooExponential | NoiseProcess::Literal => 96.0,
        NoiseProcess::Short => 16.0,
    };
    interaction.strength.sqrt() * (holds * interaction.time).clamp(time_step, 4096.0 * time_step)
}
