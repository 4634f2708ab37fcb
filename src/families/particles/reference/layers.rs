//! Frozen particles behind walls: they keep the momentum that goes with their wall, which takes up what they are given.

use crate::families::{Model, PlaneWalls};
use crate::state::State;

/// Whether a particle is frozen.
pub(super) fn is_frozen(model: &Model, state: &State, particle: usize) -> bool {
    model.species[state.species[particle] as usize].frozen
}

/// What every wall is to take up of the momenta that frozen particles have beyond those in the state; no elements without frozen particles.
pub(super) fn taken_up(model: &Model, state: &State, momenta: &[[i64; 3]]) -> Vec<[i64; 3]> {
    if !model.has_frozen_particles() {
        return Vec::new();
    }
    let walls = &model.particles().walls;
    let mut taken = vec![[0; 3]; 2 * walls.len()];
    for (particle, momentum) in momenta.iter().enumerate().filter(|(particle, _)| is_frozen(model, state, *particle)) {
        let Some((pair, upper)) = PlaneWalls::behind(walls, model.units.ends(), state.positions[particle]) else {
            continue;
        };
        for (axis, component) in momentum.iter().enumerate() {
            taken[2 * pair + usize::from(upper)][axis] += component - i64::from(state.momenta[particle][axis]);
        }
    }
    taken
}

/// Gives frozen particles the momenta in the state.
pub(super) fn hold(model: &Model, state: &State, momenta: &mut [[i64; 3]]) {
    for particle in (0..state.len()).filter(|&particle| is_frozen(model, state, particle)) {
        momenta[particle] = state.momenta[particle].map(i64::from);
    }
}
