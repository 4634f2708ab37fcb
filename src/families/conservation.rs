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
    pub(crate) fn is_exchanged(self) -> bool {
        !matches!(self, Self::Mass | Self::MeshMass)
    }

    /// Its name in a summary.
    pub(crate) fn name(self) -> String {
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
#[derive(Debug, Clone, PartialEq)]
pub struct KeptSum {
    /// The quantity.
    pub quantity: KeptQuantity,
    /// The direction of a component: ` along x`.
    pub direction: &'static str,
    /// Value of one unit.
    pub unit: f64,
    /// The places of its parts among the sums of the first sampler, and the sign of each.
    pub parts: Vec<(usize, i64)>,
    /// In a state.
    pub total: i64,
}

impl KeptSum {
    /// The kept sum, from the sums of a report.
    pub(crate) fn of(&self, sums: &[i64]) -> Option<i64> {
        self.parts
            .iter()
            .try_fold(0_i64, |sum, (place, sign)| Some(sum.wrapping_add(sums.get(*place)?.wrapping_mul(*sign))))
    }
}

/// The components of the total momentum among the sums of a report.
pub(super) fn momentum(state: &State, sums: &Sums, dimension: usize, unit: f64) -> Vec<KeptSum> {
    let Some(first) = sums.place(Sum::Momentum) else { return Vec::new() };
    let directions = [" along x", " along y", " along z"].into_iter().zip(state.total_momentum()).enumerate();
    let component = |(axis, (direction, total))| {
        let parts = vec![(first + axis, 1)];
        KeptSum { quantity: KeptQuantity::MOMENTUM, direction, unit, parts, total }
    };
    directions.take(dimension).map(component).collect()
}

/// The sum of all masses, or nothing if a report has none.
pub(super) fn mass(state: &State, quantity: KeptQuantity, sums: &Sums, unit: f64) -> Option<KeptSum> {
    let total = state.masses.iter().map(|mass| i64::from(*mass)).sum();
    let parts = vec![(sums.place(Sum::Mass)?, 1)];
    Some(KeptSum { quantity, direction: "", unit, parts, total })
}

/// Why the energy of forces is not kept exactly.
pub(crate) const INTEGRATED: &str = "only as well as the time step integrates the forces";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_count_with_their_signs() {
        let quantity = KeptQuantity::Momentum { walls: true, shear: false, body_forces: true };
        let parts = vec![(0, 1), (1, -1), (2, 1), (5, 1)];
        let sum = KeptSum { quantity, direction: "", unit: 1.0, parts, total: 0 };
        assert_eq!(sum.of(&[7, 3, 10, 0, 0, 100]), Some(7 - 3 + 10 + 100));
        // A report without one of them says nothing.
        assert_eq!(sum.of(&[7, 3, 10, 0, 0]), None);
        assert_eq!(sum.of(&[i64::MIN, 1, 0, 0, 0, 0]), Some(i64::MAX));
    }
}
