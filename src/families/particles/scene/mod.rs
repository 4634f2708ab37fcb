//! Scenes of particles: their types and checks.

mod chains;
pub(crate) mod checks;
pub(crate) mod coloured_noise;
pub(crate) mod harmonic_chain;
mod pairs;
mod single;

pub use chains::{AnglesInteraction, BondPotential, BondsInteraction};
pub use harmonic_chain::{ChainEquilibrium, ChainOutput, ChainPulse, HarmonicChainInteraction};
pub use pairs::*;
pub use single::{ColouredNoiseInteraction, LangevinInteraction, NoiseProcess, SpeciesFriction, TetherInteraction};
