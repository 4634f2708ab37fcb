//! Plans of particles: of pairs without memory, in one or two traversals a step, and of all couplings one by one.

pub(crate) mod couplings;
mod law;
pub(crate) mod pair;
mod species;

use super::layout::PARTICLE;
use crate::plan::serial_memory::Candidate;
use crate::plan::{
    Grid, Hardware, Kernel, Measured, Need, Options, Ordered, PhysicsPlan, Plan, Quanta, Reported, Texture, Traversal,
    deviate, prefix_sum, serial_memory, words,
};
use crate::shaders::{arrays, pairs};

/// Buffers that may be held in textures.
fn texture_candidates(plan: &Plan) -> Vec<Candidate> {
    let mut candidates = vec![
        Candidate::new("cells", 1, arrays::Cells::Texture),
        Candidate::new("ranks", 1, arrays::Ranks::Texture),
        Candidate::new("coefficients", 4, arrays::Coefficients::Texture),
        Candidate::new("sorted", 4, arrays::Sorted::Texture),
        Candidate::new("neighbours", 1, arrays::Neighbours::Texture),
        Candidate::new("neighbours_next", 1, arrays::NeighboursNext::Texture),
        Candidate::new("memories", 2, arrays::Memories::Texture),
        Candidate::new("memories_next", 2, arrays::MemoriesNext::Texture),
    ];
    // Where the hits of a split step share the buffer of the particles, it stays one.
    if !plan.kernels.iter().any(|kernel| kernel.choices.has(pairs::Hits::Keep)) {
        candidates.push(Candidate::new("particles", 4, arrays::Particles::Texture));
    }
    candidates
}
