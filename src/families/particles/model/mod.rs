//! The physics of particles in numbers that terms share: links between particles, and momenta that forces make.

pub(crate) mod forces;
mod molecules;
pub(crate) mod topology;

pub(crate) use molecules::Neighbours;
pub(crate) use topology::{Alike, bonded_particles};
pub use topology::{Angle, Bond, ChainGroup, Link, Walks};
