//! Quantities that models conserve exactly.

use crate::plan::Sums;
use crate::shaders::Sum;
use crate::state::State;

/// A quantity that some models keep to the last bit: a sum of integers, which every report has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptQuantity {
    /// Mass of particles or cells, which may exchange it.
    Mass,
    /// Mass on the nodes of a mesh.
    MeshMass,
    /// Momentum of all particles, including or excluding what they exchange with something else.
    Momentum {
        /// Momentum absorbed by walls is included.
        walls: bool,
        /// Momentum lost by particles that cross sheared boundaries is included.
        shear: bool,
        /// The impulse of body forces is excluded.
        body_forces: bool,
    },
    /// Kinetic and internal energy together.
    Energy,
}

impl KeptQuantity {
    /// The momentum of all particles.
    pub const MOMENTUM: Self = Self::Momentum { walls: false, shear: false, body_forces: false };

    /// True if it is kept only if both ends of a pair are computed alike, as by ranks that round alike.
    #[must_use]
    pub fn is_exchanged(self) -> bool {
        !matches!(self, Self::Mass | Self::MeshMass)
    }

    /// Its name in a summary.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Mass => "mass".to_owned(),
            Self::MeshMass => "mass on the mesh".to_owned(),
            Self::Momentum { walls, shear, body_forces } => {
                let included = match (walls, shear) {
                    (false, false) => "",
                    (true, _) => ", including that absorbed by walls",
                    (_, true) => ", including that lost at sheared boundaries",
                };
                let excluded = if body_forces { ", excluding the impulse of body forces" } else { "" };
                format!("total momentum{included}{excluded}")
            }
            Self::Energy => "total energy".to_owned(),
        }
    }
}

/// One of the integer sums that a model keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeptSum {
    /// The quantity.
    pub quantity: KeptQuantity,
    /// The direction of a component: ` along x`.
    pub direction: &'static str,
    /// Its place among the sums of the first sampler.
    pub place: usize,
    /// Value of one unit.
    pub unit: f64,
    /// The place of the sum of the impulse of body forces, which is excluded.
    pub put_in: Option<usize>,
    /// The place of the sum of the momentum absorbed by the first wall, which is included, and the number of walls, whose
    /// sums follow each other at every third place.
    pub walls: Option<(usize, usize)>,
    /// In a state.
    pub total: i64,
}

impl KeptSum {
    /// The kept sum, from the sums of a report.
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
        quantity: KeptQuantity::MOMENTUM,
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
