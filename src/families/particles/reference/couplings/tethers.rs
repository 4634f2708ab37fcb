//! A spring from every particle to where it started: V = K d²/2.

use super::push;
use crate::families::Model;
use crate::state::State;

/// The displacement d of a particle from the end of its tether.
pub(super) fn displacement(model: &Model, state: &State, particle: usize) -> [f64; 3] {
    model.units.displacement(state.positions[particle], state.tethers[particle])
}

/// Adds the half kicks of all tethers.
pub(super) fn kick(model: &Model, stiffness: f64, state: &State, kick: &mut [[i64; 3]]) {
    for (particle, sum) in kick.iter_mut().enumerate() {
        let impulse = displacement(model, state, particle).map(|d| -0.5 * model.time_step * stiffness * d);
        push(sum, impulse, model.units.momentum);
    }
}
