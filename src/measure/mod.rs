//! Averages and derived quantities from raw sums.

pub mod correlation;
mod observables;
pub mod statistics;
mod sums;

pub use observables::Observables;
pub use sums::observables_of;
