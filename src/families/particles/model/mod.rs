//! The physics of particles in numbers: pair coefficients, bonds, angles, baths of coordinates, chains.

mod angles;
mod body_force;
mod bonds;
mod chain_trio;
mod coloured_noise;
mod dpd;
pub(crate) mod forces;
mod harmonic_chain;
mod many_body;
mod molecules;
mod position;
mod pulse;
mod relaxation;
mod shear;
pub(crate) mod surroundings;
mod thermal_start;
mod time_scales;
pub(crate) mod topology;
mod walls;

pub use angles::{Angle, Angles};
pub use body_force::{BodyForces, FixedImpulse};
pub use bonds::{Bond, BondKind, Bonds};
pub use chain_trio::{ChainTrios, Likeness, Strand};
pub use coloured_noise::{ColouredNoise, Jump};
pub use dpd::{PairForce, SoftRepulsion};
pub use harmonic_chain::{HarmonicChain, SpringChain};
pub use many_body::ManyBodyForce;
pub use position::PositionBath;
pub use pulse::{HalfPulse, Pulse, half_pulses};
pub(crate) use relaxation::{MOST_RELAXATION, RelaxationErrors, TOLERANCE};
pub use shear::ShearedBox;
pub use thermal_start::thermal_start;
pub(crate) use time_scales::FREQUENCY_LIMIT;
pub(crate) use topology::Alike;
pub use topology::{ChainGroup, Walks};
pub use walls::PlaneWalls;
