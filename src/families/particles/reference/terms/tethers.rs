//! A spring from every particle to where it started: V = K d²/2.

use super::push;
use crate::families::Model;
use crate::state::State;

/// The displacement d of a particle from the end of its tether.
pub(in crate::families::particles::reference) fn displacement(
    model: &Model,
    state: &State,
    particle: usize,
) -> [f64; 3] {
    model.units.displacement(state.positions[particle], state.tethers[particle])
}

/// V, the part of each axis by itself.
pub(in crate::families::particles::reference) fn energies(stiffness: f64, displacement: [f64; 3]) -> [f64; 3] {
    displacement.map(|d| 0.5 * stiffness * d * d)
}

/// ∇V.
pub(in crate::families::particles::reference) fn gradient(stiffness: f64, displacement: [f64; 3]) -> [f64; 3] {
    displacement.map(|d| stiffness * d)
}

/// ∇²V.
pub(in crate::families::particles::reference) fn laplacian(stiffness: f64, dimension: usize) -> f64 {
    stiffness * dimension as f64
}

/// Adds the half kicks -dt/2 ∇V of all tethers.
pub(in crate::families::particles::reference) fn kick(
    model: &Model,
    stiffness: f64,
    state: &State,
    kick: &mut [[i64; 3]],
) {
    for (particle, sum) in kick.iter_mut().enumerate() {
        let impulse = gradient(-0.5 * model.time_step * stiffness, displacement(model, state, particle));
        push(sum, impulse, model.units.momentum);
    }
}
