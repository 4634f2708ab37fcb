//! Averages and derived quantities from raw sums.

mod observables;
mod sums;

pub use observables::Observables;
pub use sums::observables_of;
