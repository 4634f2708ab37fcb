//! Plans of particles.

pub(crate) mod bonded;
pub(crate) mod quanta;
mod species;
pub(crate) mod step;
pub(crate) mod stress;

use super::layout::PARTICLE;
use crate::document::Integrator;
use crate::families::Model;
use crate::plan::{
    Grid, Hardware, Kernel, Measured, Need, Options, PhysicsPlan, Plan, Quanta, Texture, Traversal, generator,
    prefix_sum, serial_memory,
};
use crate::shaders::{Array, pairs};

/// Whether particles carry predicted momenta, which friction sees in the place of their own.
fn predicted(model: &Model) -> bool {
    matches!(model.particles().integrator, Integrator::GrootWarren { lambda } if lambda != 0.5)
}

/// Buffers that may be held in textures.
fn texture_candidates(plan: &Plan) -> Vec<Array> {
    let mut candidates =
        vec![Array::Cells, Array::Ranks, Array::Coefficients, Array::Sorted, Array::Neighbours, Array::Memories];
    // Where the hits of a split step share the buffer of the particles, it stays one; so it does where a split step has
    // none, because its kernels are the same.
    let splits = |kernel: &Kernel| kernel.choices.has(pairs::Hits::Keep) || kernel.choices.has(pairs::Pass::Kick);
    // Nor does it where the host adds particles of other ranks.
    if !plan.kernels.iter().any(splits) && plan.part.is_none() {
        candidates.push(Array::Particles);
    }
    // Where another buffer takes its place in some kernels, it stays one.
    if plan.has_buffer(Array::Staged) {
        candidates.retain(|array| *array != Array::Sorted);
    }
    candidates
}
