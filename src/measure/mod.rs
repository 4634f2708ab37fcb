//! Averages and derived quantities from raw sums.

mod observables;

pub use observables::Observables;
