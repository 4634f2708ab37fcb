//! Particles that are held: fixed in space, or frozen behind a wall, which absorbs the impulses on them. They keep the
//! momentum that they have.

use crate::families::{Model, PlaneWalls};
use crate::state::State;

/// Whether no impulse moves a particle.
pub(crate) fn is_held(model: &Model, state: &State, particle: usize) -> bool {
    model.species[state.species[particle] as usize].fixed
}

/// Whether a particle is frozen.
pub(crate) fn is_frozen(model: &Model, state: &State, particle: usize) -> bool {
    model.species[state.species[particle] as usize].frozen
}

/// The momentum that every wall is to absorb: that of frozen particles beyond the one in the state; no elements without
/// frozen particles.
pub(crate) fn absorbed(model: &Model, state: &State, momenta: &[[i64; 3]]) -> Vec<[i64; 3]> {
    if model.frozen_particles() == 0 {
        return Vec::new();
    }
    let walls = &model.particles().walls;
    let mut absorbed = vec![[0; 3]; 2 * walls.len()];
    for (particle, momentum) in momenta.iter().enumerate().filter(|(particle, _)| is_frozen(model, state, *particle)) {
        let Some((pair, upper)) = PlaneWalls::behind(walls, model.units.ends(), state.positions[particle]) else {
            continue;
        };
        for (axis, component) in momentum.iter().enumerate() {
            absorbed[2 * pair + usize::from(upper)][axis] += component - i64::from(state.momenta[particle][axis]);
        }
    }
    absorbed
}

/// Gives held particles the momenta in the state.
pub(crate) fn hold(model: &Model, state: &State, momenta: &mut [[i64; 3]]) {
    for particle in (0..state.len()).filter(|&particle| is_held(model, state, particle)) {
        momenta[particle] = state.momenta[particle].map(i64::from);
    }
}

/// Leaves out impulses on held particles.
pub(crate) fn exclude(model: &Model, state: &State, impulses: &mut [[i64; 3]]) {
    for particle in (0..state.len()).filter(|&particle| is_held(model, state, particle)) {
        impulses[particle] = [0; 3];
    }
}
