//! What crosses faces, handed to both cells with opposite signs in whole units.
//!
//! The integer state holds kinetic and internal energy of a cell together, so that mass, momentum and total energy are
//! constant to the last bit.

use super::faces::{Face, dot};
use crate::families::reference::Unstable;
use crate::families::{Model, Voronoi};
use crate::state::State;

/// What crosses a face into k, but for the work of what crosses.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Exchange {
    /// ΔP.
    pub(super) momentum: [f64; 2],
    /// ΔM.
    pub(super) mass: f64,
    /// Heat, and energy that goes with mass.
    pub(super) energy: f64,
    /// The part of the work that is not shared equally is this times Ūₖ - Ūₗ.
    pub(super) skew: [f64; 2],
}

impl Exchange {
    pub(super) fn add(&mut self, other: &Self) {
        for axis in 0..2 {
            self.momentum[axis] += other.momentum[axis];
            self.skew[axis] += other.skew[axis];
        }
        self.mass += other.mass;
        self.energy += other.energy;
    }

    /// The total energy that crosses into k, from velocities U before and U' after.
    ///
    /// With Ū = (U + U')/2 the kinetic energy of both cells together grows by
    /// W = ΔP·(Ūₖ - Ūₗ) - ½ΔM (Uₖ·Uₖ' - Uₗ·Uₗ'), exactly; half of it is taken from each internal energy.
    pub(super) fn total_energy(&self, face: &Face, before: &[[f64; 2]], after: &[[f64; 2]]) -> f64 {
        let middle = |cell: usize| [0, 1].map(|axis| 0.5 * (before[cell][axis] + after[cell][axis]));
        let [middle_k, middle_l] = [middle(face.k), middle(face.l)];
        let sum = [middle_k[0] + middle_l[0], middle_k[1] + middle_l[1]];
        let difference = [middle_k[0] - middle_l[0], middle_k[1] - middle_l[1]];
        let carried = dot(before[face.k], after[face.k]) + dot(before[face.l], after[face.l]);
        0.5 * dot(self.momentum, sum) - 0.25 * self.mass * carried + dot(self.skew, difference) + self.energy
    }
}

/// Sums over the faces of each cell, in units of the state.
pub(super) struct Ledger {
    pub(super) momenta: Vec<[i64; 2]>,
    pub(super) masses: Vec<i64>,
    pub(super) energies: Vec<i64>,
}

impl Ledger {
    pub(super) fn new(cells: usize) -> Self {
        Self { momenta: vec![[0; 2]; cells], masses: vec![0; cells], energies: vec![0; cells] }
    }

    /// Hands momentum and mass to both cells.
    pub(super) fn hand(&mut self, model: &Model, cells: &Voronoi, face: &Face, exchange: &Exchange) {
        for axis in 0..2 {
            let units = whole(exchange.momentum[axis] / model.units.momentum);
            self.momenta[face.k][axis] += units;
            self.momenta[face.l][axis] -= units;
        }
        let units = whole(exchange.mass / cells.mass_unit);
        self.masses[face.k] += units;
        self.masses[face.l] -= units;
    }

    /// Hands total energy to both cells.
    pub(super) fn hand_energy(&mut self, cells: &Voronoi, face: &Face, energy: f64) {
        let units = whole(energy / cells.energy_unit);
        self.energies[face.k] += units;
        self.energies[face.l] -= units;
    }

    /// Adds the sums to a state.
    pub(super) fn apply_to(&self, state: &mut State) -> Result<(), Unstable> {
        let step = state.step;
        for particle in 0..state.len() {
            for axis in 0..2 {
                let momentum = i64::from(state.momenta[particle][axis]) + self.momenta[particle][axis];
                state.momenta[particle][axis] =
                    i32::try_from(momentum).map_err(|_| Unstable::Momentum { step, particle })?;
            }
            let mass = u32::try_from(i64::from(state.masses[particle]) + self.masses[particle]);
            match mass {
                Ok(mass) if mass > 0 => state.masses[particle] = mass,
                _ => return Err(Unstable::Mass { step, particle }),
            }
        }
        for (particle, energy) in state.energies.iter_mut().enumerate() {
            let sum = i64::from(*energy) + self.energies[particle];
            *energy = i32::try_from(sum).map_err(|_| Unstable::Energy { step, particle })?;
        }
        Ok(())
    }
}

/// Rounds half to even; more than the state could hold is as good as twice that.
fn whole(units: f64) -> i64 {
    const MOST: f64 = (1_u64 << 33) as f64;
    units.round_ties_even().clamp(-MOST, MOST) as i64
}
