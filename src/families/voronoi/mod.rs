//! Voronoi DPD: particles that are the cells of a tessellation.

pub(crate) mod model;
pub mod reference;
pub(crate) mod scene;
pub(crate) mod start;

use super::{Physics, Species, Voronoi, units};
use crate::scene::Scene;

impl Physics for Voronoi {
    fn momentum_unit(&self, scene: &Scene, species: &[Species]) -> f64 {
        // Cells that come close throw each other apart, at steps that are too long for them by hundreds of these momenta.
        units::momentum_unit(scene, species, None, None, 20.0)
    }

    fn has_potential(&self) -> bool {
        // Pressures that follow from the gradient of a free energy.
        !self.exchanges_mass() && !self.keeps_energy()
    }

    fn has_memory(&self) -> bool {
        false
    }

    fn is_free(&self) -> bool {
        true
    }
}
