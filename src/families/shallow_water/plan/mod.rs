//! The plan of shallow water.

mod part;
pub mod smoothing;
mod steps;

pub(super) use steps::Arithmetic;
pub(crate) use steps::plan;

use crate::plan::{
    Buffer, Hardware, Kernel, Measured, Options, PhysicsPlan, Plan, Quanta, Storage, Texture, Traversal, generator,
    prefix_sum,
};

/// Bytes of a particle or tracer.
const WATER: u64 = 24;
