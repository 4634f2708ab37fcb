//! What a scene says about particles.

mod body_force;
mod chains;
mod harmonic_chain;
mod pairs;
mod single;

pub use body_force::{BodyForceInteraction, ForceProfile};
pub use chains::{AnglesInteraction, BondPotential, BondsInteraction};
pub use harmonic_chain::{ChainEquilibrium, ChainOutput, ChainPulse, HarmonicChainInteraction};
pub use pairs::*;
pub use single::{
    ColouredNoiseInteraction, FrictionVelocity, LangevinInteraction, NoiseProcess, SpeciesFriction, TetherInteraction,
};
