//! What models conserve exactly.

use crate::plan::Sums;
use crate::shaders::Sum;
use crate::state::State;

/// What some models keep to the last bit: sums of integers, which every report has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptQuantity {
    /// Of what exchanges it, or might.
    Mass,
    /// On the nodes of a mesh.
    MeshMass,
    /// Of all particles.
    Momentum,
    /// Of all particles, less what body forces have put in.
    MomentumButForForces,
    /// Of all particles, with what walls have taken up.
    MomentumWithWalls,
    /// Both.
    MomentumWithWallsButForForces,
    /// Of all particles, with what boundaries that shear have taken from those that crossed them.
    MomentumWithShear,
    /// Kinetic and internal energy together.
    Energy,
}

impl KeptQuantity {
    /// Whether it is kept only if both ends of a pair are computed alike, as by ranks that round alike.
    #[must_use]
    pub fn is_exchanged(self) -> bool {
        !matches!(self, Self::Mass | Self::MeshMass)
    }

    /// Its name in a summary.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::MeshMass => "mass on the mesh",
            Self::Momentum => "total momentum",
            Self::MomentumButForForces => "total momentum less what body forces have put in",
            Self::MomentumWithWalls => "total momentum with what walls have taken up",
            Self::MomentumWithWallsButForForces => {
                "total momentum with what walls have taken up, less what body forces have put in"
            }
            Self::MomentumWithShear => {
                "total momentum with what boundaries that shear have taken from those that crossed them"
            }
            Self::Energy => "total energy",
        }
    }
}

/// One of the integer sums that a model keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeptSum {
    /// What it is of.
    pub quantity: KeptQuantity,
    /// The direction of a component: ` along x`.
    pub direction: &'static str,
    /// Its place among the sums of the first sampler.
    pub place: usize,
    /// Value of one unit.
    pub unit: f64,
    /// The place of the sum of what is put in from outside, which does not count.
    pub put_in: Option<usize>,
    /// The place of the sum of what the first wall has taken up, which counts too, and the number of walls, whose sums follow each other at
    /// every third place.
    pub walls: Option<(usize, usize)>,
    /// In a state.
    pub total: i64,
}

impl KeptSum {
    /// The same of a component of momentum, but for what body forces have put in: the place of that sum.
    pub(super) fn but_for(self, place: usize) -> Self {
        Self { quantity: KeptQuantity::MomentumButForForces, put_in: Some(place), ..self }
    }

    /// The same of a component of momentum, with what so many walls have taken up: the place of the sum of the first.
    pub(super) fn with_walls(self, place: usize, number: usize) -> Self {
        let quantity = match self.quantity {
            KeptQuantity::MomentumButForForces => KeptQuantity::MomentumWithWallsButForForces,
            _ => KeptQuantity::MomentumWithWalls,
        };
        Self { quantity, walls: Some((place, number)), ..self }
    }

    /// The same with what boundaries that shear have taken up in the place of walls.
    pub(super) fn with_shear(self) -> Self {
        Self { quantity: KeptQuantity::MomentumWithShear, ..self }
    }

    /// What is kept, among the sums of a report.
    #[must_use]
    pub fn of(&self, sums: &[i64]) -> Option<i64> {
        let found = sums.get(self.place)?;
        let put_in = self.put_in.map_or(Some(0), |place| sums.get(place).copied())?;
        let (first, number) = self.walls.unwrap_or_default();
        let taken = (0..number).try_fold(0_i64, |sum, wall| Some(sum.wrapping_add(*sums.get(first + 3 * wall)?)))?;
        Some(found.wrapping_sub(put_in).wrapping_add(taken))
    }
}

/// The components of the total momentum among the sums of a report.
pub(super) fn momentum(state: &State, sums: &Sums, dimension: usize, unit: f64) -> Vec<KeptSum> {
    let Some(first) = sums.place(Sum::Momentum) else { return Vec::new() };
    let directions = [" along x", " along y", " along z"].into_iter().zip(state.total_momentum()).enumerate();
    let component = |(axis, (direction, total))| KeptSum {
        quantity: KeptQuantity::Momentum,
        direction,
        place: first + axis,
        unit,
        put_in: None,
        walls: None,
        total,
    };
    directions.take(dimension).map(component).collect()
}

/// The sum of all masses, or nothing if a report has none.
pub(super) fn mass(state: &State, quantity: KeptQuantity, sums: &Sums, unit: f64) -> Option<KeptSum> {
    let total = state.masses.iter().map(|mass| i64::from(*mass)).sum();
    let place = sums.place(Sum::Mass)?;
    Some(KeptSum { quantity, direction: "", place, unit, put_in: None, walls: None, total })
}

/// Why the energy of forces is not kept exactly.
pub(crate) const INTEGRATED: &str = "only as well as the time step integrates the forces";
