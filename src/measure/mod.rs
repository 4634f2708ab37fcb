//! Averages, fields and derived quantities from raw sums.

pub mod correlation;
mod field;
mod observables;
pub mod statistics;
mod sums;

pub use field::{Field, FieldError};
pub use observables::Observables;
pub use sums::observables_of;
