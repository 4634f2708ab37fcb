//! Averages, fields and derived quantities from raw sums.

pub mod blocks;
pub mod correlation;
pub mod diffusion;
pub mod equilibration;
pub mod fit;
pub mod green_kubo;
pub mod harmonic_chain;
pub mod histogram;
mod line;
pub mod neighbours;
pub(crate) mod peak;
pub mod shear_viscosity;
pub mod shear_wave;
pub mod statistics;
pub mod stress;
mod sums;
pub mod wave_vectors;

pub use crate::families::shallow_water::{circulation, flow::MeshFlow};
pub use crate::families::{CellObservables, Field, FieldError, Observables};
pub use sums::observables_of;
