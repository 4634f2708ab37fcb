//! What is known exactly of a harmonic chain and of its clusters, and what is measured of them.
//!
//! [`NormalModes`] moves a chain without noise and gives the momentum autocorrelation of its clusters; [`equilibrium`]
//! has their variances; [`MemoryKernel`] is the memory that coarse-graining leaves. [`Pulse`] and [`HalfPulse`] start
//! and describe a pulse, [`thermal_start`] and [`ThermalSeries`] a chain in equilibrium.

pub mod equilibrium;
mod memory_kernel;
mod normal_modes;
mod pulse;
mod thermal_series;
mod thermal_start;

pub use memory_kernel::{MemoryKernel, Plateau};
pub use normal_modes::NormalModes;
pub use pulse::{HalfPulse, Pulse, half_pulses};
pub use thermal_series::{ThermalEstimates, ThermalSeries};
pub use thermal_start::thermal_start;
