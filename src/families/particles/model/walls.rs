//! Plane walls in numbers.

use crate::document::{Reflection, Scene};
use crate::families::Model;

/// The two walls across an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneWalls {
    /// The axis that they cross.
    pub axis: usize,
    /// What becomes of velocities.
    pub reflection: Reflection,
    /// Velocities of the lower and of the upper wall, along the walls.
    pub velocities: [[f64; 3]; 2],
}

/// The empty space behind walls, as a multiple of the largest cutoff: what is more than one of it keeps rounded distances across it
/// beyond the cutoff.
const GAP: f64 = 1.0 + 1.0 / 1024.0;
/// The same as a part of the edge, where there are no pairs.
const GAP_WITHOUT_PAIRS: f64 = 0.25;

impl PlaneWalls {
    /// All of a scene.
    pub(crate) fn of(scene: &Scene) -> Vec<Self> {
        let walls = scene.space.walls.of_axes().into_iter().enumerate();
        let plane = |(axis, pair): (usize, Option<&crate::document::WallPair>)| {
            pair.map(|pair| Self { axis, reflection: pair.reflection, velocities: pair.velocities() })
        };
        walls.filter_map(plane).collect()
    }

    /// The empty space behind the walls, by which the period of positions along their axis is longer than the box.
    pub(crate) fn gap(cutoff: Option<f64>, edge: f64) -> f64 {
        cutoff.map_or(GAP_WITHOUT_PAIRS * edge, |cutoff| GAP * cutoff)
    }

    /// Whether one of them moves.
    #[must_use]
    pub fn move_along(&self) -> bool {
        self.velocities.iter().flatten().any(|component| *component != 0.0)
    }

    /// What a reflection makes of a unit of momentum along each axis: -1 or 1.
    #[must_use]
    pub fn signs(&self) -> [i32; 3] {
        std::array::from_fn(|axis| if axis == self.axis || self.reflection == Reflection::BounceBack { -1 } else { 1 })
    }

    /// What a particle of a species gains at one of them beside: twice its mass times the velocity of the wall, in units of momentum,
    /// in the single precision of kernels.
    #[must_use]
    pub fn push(&self, upper: bool, species: usize, model: &Model) -> [f64; 3] {
        self.velocities[usize::from(upper)]
            .map(|velocity| (2.0 * velocity * model.species[species].mass / model.units.momentum).round_ties_even())
    }
}
