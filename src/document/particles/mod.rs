//! What a scene says about particles.

mod body_force;
mod chains;
mod electrostatics;
mod harmonic_chain;
mod pairs;
mod single;

pub use body_force::*;
pub use chains::*;
pub use electrostatics::*;
pub use harmonic_chain::*;
pub use pairs::*;
pub use single::*;
