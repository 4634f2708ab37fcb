//! Averages, fields and derived quantities from raw sums.

pub mod circulation;
pub mod correlation;
pub mod diffusion;
pub mod equilibration;
mod field;
pub mod fit;
pub mod harmonic_chain;
pub mod histogram;
mod line;
mod mesh_fields;
pub mod neighbours;
pub mod shear_viscosity;
pub mod shear_wave;
pub mod statistics;
mod sums;

pub use crate::families::{CellObservables, Observables};
pub use field::{Field, FieldError};
pub use mesh_fields::MeshFlow;
pub use sums::observables_of;
