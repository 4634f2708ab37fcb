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
