//! Rotating shallow water by the Hamiltonian particle-mesh method.

pub(crate) mod model;
pub mod reference;
pub(crate) mod scene;
pub mod surface;

use super::{Physics, ShallowWater, Species};
use crate::scene::{Scene, Velocities};

impl Physics for ShallowWater {
    fn momentum_unit(&self, scene: &Scene, _: &[Species]) -> f64 {
        velocity_unit(scene, self)
    }

    fn has_potential(&self) -> bool {
        true
    }

    fn has_memory(&self) -> bool {
        self.bath.is_some_and(|bath| bath.remembers())
    }

    fn is_free(&self) -> bool {
        false
    }
}

/// A power of two near 2⁻²⁹ of the largest velocity expected in shallow water, where the speed of waves is a high one.
fn velocity_unit(scene: &Scene, water: &ShallowWater) -> f64 {
    let mass = water.nodes() as f64 / water.carriers.max(1) as f64;
    let mut scale = water.wave_speed.max(8.0 * (scene.temperature / mass).sqrt());
    for group in &scene.particles {
        if let Velocities::Listed { velocities } = &group.velocities {
            scale = velocities.iter().flatten().fold(scale, |most, velocity| most.max(velocity.abs()));
        }
    }
    (scale.log2().ceil() - 29.0).exp2()
}
