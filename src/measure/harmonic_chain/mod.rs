//! What is known exactly of a harmonic chain and of its clusters, and what is measured of them.
//!
//! [`NormalModes`] moves a chain without noise and gives the momentum autocorrelation of its clusters; [`equilibrium`]
//! has their variances; [`MemoryKernel`] is the memory that coarse-graining leaves. [`Pulse`] and [`HalfPulse`] start
//! and describe a pulse, [`thermal_start`] and [`ThermalSeries`] a chain in equilibrium.

pub mod equilibrium;
mod memory_kernel;
mod normal_modes;
mod thermal_series;

pub use crate::families::particles::terms::harmonic_chain::{HalfPulse, Pulse, half_pulses, thermal_start};
pub use memory_kernel::{MemoryKernel, Plateau};
pub use normal_modes::NormalModes;
pub use thermal_series::{ThermalEstimates, ThermalSeries};
