//! Body forces in numbers.

mod electric_field;
pub(crate) mod plan;
pub(crate) mod reference;
mod scene;

use scene::check_length;
pub(crate) use scene::check_together;

use super::{PlannedTerm, Term};
use crate::document::{ForceProfile, Problems};
use crate::families::{Checked, Model};
use crate::state::{Account, State};

/// The body forces of a scene, of one profile.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyForces {
    /// How they vary in space.
    pub profile: ForceProfile,
    /// The axis along which they vary.
    pub axis: usize,
    /// Waves in the box, of a sine.
    pub waves: u32,
    /// The part of a turn that uniform forces which oscillate make in a step, in 2⁻³².
    pub turn: Option<u32>,
    /// The force on a particle of each species.
    pub forces: Vec<[f64; 3]>,
}

/// Parts of a turn.
const TURN: f64 = 4_294_967_296.0;

/// An impulse of half a step in units of momentum: [`Self::FRACTIONS`] of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FixedImpulse(pub i64);

impl FixedImpulse {
    /// Parts of a unit that are kept.
    pub const FRACTIONS: f64 = 4_294_967_296.0;

    /// Whole units and the rest, which is not negative.
    pub(crate) fn parts(self) -> (i32, u32) {
        ((self.0 >> 32) as i32, self.0 as u32)
    }

    /// Whole units of a step: n steps add up to n times the impulse, less than a unit off.
    pub(crate) fn in_step(self, step: u64) -> i64 {
        // Beyond the last number of a step there is one more.
        let until = |steps: i128| (i128::from(self.0) * steps) >> 32;
        (until(i128::from(step) + 1) - until(i128::from(step))) as i64
    }
}

impl PlannedTerm for BodyForces {}

impl Term for BodyForces {
    fn energy_source(&self) -> Option<&'static str> {
        Some("added by body forces, whose work is `body_force_work` in the table of energies")
    }

    fn momentum_source(&self) -> Option<&'static str> {
        Some("body forces add it, as much as `body_force_momentum` in the table of energies says")
    }

    fn check_capacity(&self, scene: &Checked, problems: &mut Problems) {
        scene::check_impulses(scene, self, problems);
    }

    fn complete_start(&self, state: &mut State, _: &Model) {
        state.account = vec![Account::default()];
    }
}

impl BodyForces {
    /// The impulse of half a step on a particle of a species where the force is as large as it gets; none on one that is not there.
    pub(crate) fn impulse(&self, model: &Model, species: usize) -> [FixedImpulse; 3] {
        let units = 0.5 * model.time_step / model.units.momentum * FixedImpulse::FRACTIONS;
        let force = self.forces.get(species).copied().unwrap_or_default();
        force.map(|force| FixedImpulse((force * units).round() as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_units_of_steps_add_up_to_the_impulse() {
        for fixed in [1_i64, -1, 3 << 30, -(3 << 30), (5 << 32) + 7, -(5 << 32) - 12_345_678_901] {
            let mut sum = 0;
            for step in 0..1000 {
                sum += i128::from(FixedImpulse(fixed).in_step(step));
                let exact = i128::from(fixed) * i128::from(step + 1);
                assert!((0..1_i128 << 32).contains(&(exact - (sum << 32))), "{fixed} {step}");
            }
        }
        assert_eq!(FixedImpulse(-1).parts(), (-1, u32::MAX));
        assert_eq!(FixedImpulse((2 << 32) + 5).parts(), (2, 5));
    }
}
