//! Random words of baths on single particles.

use crate::families::Model;
use crate::noise::{self, stream};
use crate::shaders::Constant;

/// The key of their stream over all steps.
pub(super) fn stream(model: &Model) -> [(Constant, f64); 2] {
    let key = noise::seed_key(model.seed, stream::PARTICLE);
    [(Constant::ParticleStreamX, f64::from(key[0])), (Constant::ParticleStreamY, f64::from(key[1]))]
}
