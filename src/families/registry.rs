//! All families of models.

use super::{Particles, Physics, ShallowWater, Species, Voronoi};
use crate::scene::{Interaction, Scene};

/// A family, with what a model of it has.
#[derive(Debug, Clone, PartialEq)]
pub enum Family {
    /// Particles with forces between them.
    Particles(Box<Particles>),
    /// Shallow water on particles and a mesh.
    ShallowWater(ShallowWater),
    /// Voronoi cells.
    Voronoi(Voronoi),
}

impl Family {
    /// The family of a scene; some add species.
    pub(super) fn of(scene: &Scene, species: &mut Vec<Species>) -> Self {
        for interaction in &scene.interactions {
            match interaction {
                Interaction::ShallowWater(water) => return Self::ShallowWater(ShallowWater::new(water, scene)),
                Interaction::Voronoi(cells) => return Self::Voronoi(Voronoi::new(cells, scene, species)),
                _ => {}
            }
        }
        Self::Particles(Box::new(Particles::new(scene, species)))
    }

    /// Its physics.
    #[must_use]
    pub(crate) fn physics(&self) -> &dyn Physics {
        match self {
            Self::Particles(particles) => particles.as_ref(),
            Self::ShallowWater(water) => water,
            Self::Voronoi(cells) => cells,
        }
    }
}
