//! Random words of baths on single particles.

use crate::families::Model;
use crate::noise::{self, stream};
use crate::plan::switch;
use crate::shaders::Constant;

/// The key of their stream over all steps, and whether they draw any.
pub(super) fn stream(model: &Model) -> [(Constant, f64); 3] {
    let key = noise::seed_key(model.seed, stream::PARTICLE);
    let noisy = model.particles().position_bath.as_ref().is_some_and(|bath| bath.temperature > 0.0);
    [
        switch(Constant::PositionBathsNoisy, noisy),
        (Constant::ParticleStreamX, f64::from(key[0])),
        (Constant::ParticleStreamY, f64::from(key[1])),
    ]
}
