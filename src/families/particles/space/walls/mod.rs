//! Plane walls in numbers.

pub(crate) mod plan;
pub(crate) mod reference;
pub(crate) mod scene;

use crate::document::{Placement, Reflection, Scene, WallPair};
use crate::families::Model;
use crate::families::particles::terms::{PlannedTerm, ReferenceTerm, Term};

/// The two walls across an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneWalls {
    /// The axis that they cross.
    pub axis: usize,
    /// What becomes of velocities.
    pub reflection: Reflection,
    /// Velocities of the lower and of the upper wall, along the walls.
    pub velocities: [[f64; 3]; 2],
    /// Thickness of the layers of frozen particles behind them, of the thicker one; 0 without any.
    pub layer: f64,
}

/// The empty space behind walls and their layers, as a multiple of the largest cutoff: what is more than one of it keeps rounded distances
/// across it beyond the cutoff.
const GAP: f64 = 1.0 + 1.0 / 1024.0;
/// The same as a part of the edge, where there are no pairs.
const GAP_WITHOUT_PAIRS: f64 = 0.25;

impl PlannedTerm for PlaneWalls {}
impl ReferenceTerm for PlaneWalls {}

impl Term for PlaneWalls {
    fn energy_source(&self) -> Option<&'static str> {
        let way = "added by moving walls, whose work is `wall_work` in the table of energies";
        self.move_along().then_some(way)
    }

    fn momentum_source(&self) -> Option<&'static str> {
        Some("walls absorb it, as much as the columns `wall_..._momentum_...` in the table of energies say")
    }
}

impl PlaneWalls {
    /// All of a scene.
    pub(crate) fn of(scene: &Scene) -> Vec<Self> {
        let walls = scene.space.walls.of_axes().into_iter().enumerate();
        let layer = |axis: usize| {
            let thicknesses = scene.particles.iter().map(|group| match group.placement {
                Placement::BehindWalls { axis: across, thickness, .. } if across as usize == axis => thickness,
                _ => 0.0,
            });
            thicknesses.fold(0.0, f64::max)
        };
        let plane = |(axis, pair): (usize, Option<&WallPair>)| {
            let pair = pair?;
            Some(Self { axis, reflection: pair.reflection, velocities: pair.velocities(), layer: layer(axis) })
        };
        walls.filter_map(plane).collect()
    }

    /// The space behind the walls, by which the period of positions along their axis is longer than the box: layers of frozen particles, and
    /// between them what keeps both sides out of reach of each other.
    pub(crate) fn gap(&self, cutoff: Option<f64>, edge: f64) -> f64 {
        2.0 * self.layer + cutoff.map_or(GAP_WITHOUT_PAIRS * edge, |cutoff| GAP * cutoff)
    }

    /// Whether one of them moves.
    pub(crate) fn move_along(&self) -> bool {
        self.velocities.iter().flatten().any(|component| *component != 0.0)
    }

    /// What a reflection makes of a unit of momentum along each axis: -1 or 1.
    pub(crate) fn signs(&self) -> [i32; 3] {
        std::array::from_fn(|axis| if axis == self.axis || self.reflection == Reflection::BounceBack { -1 } else { 1 })
    }

    /// What a particle of a species gains at one of them beside: twice its mass times the velocity of a wall that reverses velocities, in units
    /// of momentum, in the single precision of kernels.
    pub(crate) fn push(&self, upper: bool, species: usize, model: &Model) -> [f64; 3] {
        self.pushing(upper)
            .map(|velocity| (2.0 * velocity * model.species[species].mass / model.units.momentum).round_ties_even())
    }

    /// The velocity that a reflection knows of: a specular one leaves what is along the wall as it is.
    pub(crate) fn pushing(&self, upper: bool) -> [f64; 3] {
        match self.reflection {
            Reflection::BounceBack => self.velocities[usize::from(upper)],
            Reflection::Specular => [0.0; 3],
        }
    }

    /// The momentum that a frozen particle of a mass keeps behind one of them, in units of momentum.
    pub(crate) fn carried(&self, upper: bool, mass: f64, model: &Model) -> [i32; 3] {
        self.velocities[usize::from(upper)]
            .map(|velocity| (mass * velocity / model.units.momentum).round_ties_even() as i32)
    }

    /// Behind which of the walls across their axes a place is, if behind any: the number of the walls and whether it is the upper one.
    pub(crate) fn behind(walls: &[Self], ends: [u32; 3], place: [u32; 3]) -> Option<(usize, bool)> {
        walls.iter().enumerate().find_map(|(number, pair)| {
            let beyond = place[pair.axis].checked_sub(ends[pair.axis])?;
            Some((number, beyond < ends[pair.axis].wrapping_neg() / 2))
        })
    }
}
