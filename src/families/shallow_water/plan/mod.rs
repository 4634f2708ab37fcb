//! The plan of shallow water.

pub mod smoothing;
mod steps;

pub(crate) use steps::plan;

use crate::plan::{
    Bins, Buffer, Contents, Hardware, Kernel, Layout, Options, Plan, Quanta, Sampler, SamplerId, Storage, Texture,
    Traversal, prefix_sum, recording, words,
};
