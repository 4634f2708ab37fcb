//! From samples to averages with errors.

pub mod correlation;
pub mod statistics;
