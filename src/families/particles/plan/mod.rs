//! Plans of particles: of pairs without memory, in one or two traversals a step, and of all couplings one by one.

pub(crate) mod couplings;
mod law;
pub(crate) mod pair;
mod species;

use crate::plan::{
    Grid, Hardware, Kernel, Layout, Listed, Options, Plan, Quanta, Texture, Traversal, analyses, deviate, layout,
    pair_histogram, prefix_sum, serial_memory, words,
};
