//! How particles start, once their places and momenta are known: at rest together, and with what their terms start
//! with.

use super::space::walls::plan as walls;
use super::terms;
use crate::families::start::bring_to_rest;
use crate::families::{Checked, Particles};
use crate::state::{State, WallImpulse};
use std::mem;
use std::ops::Range;

/// Gives particles at their places what they start with.
pub(super) fn complete(particles: &Particles, state: &mut State, scene: &Checked, thermal: &[Range<usize>]) {
    let model = scene.model();
    for term in terms::acting(scene) {
        term.add_particles(scene, state, model);
    }
    if model.exchanges_momentum() {
        let species = mem::take(&mut state.species);
        bring_to_rest(state, thermal, model.units.dimension, |id| model.species[species[id] as usize].mass);
        state.species = species;
    }
    if particles.tethers.is_none() {
        state.tethers = Vec::new();
    }
    for term in particles.terms() {
        term.complete_start(state, model);
    }
    state.walls = vec![WallImpulse::default(); walls::count(model)];
    if let Some(shear) = &particles.shear {
        for id in thermal.iter().cloned().flatten() {
            let flow = shear.flow(state.species[id] as usize, state.positions[id][shear.gradient], model);
            state.momenta[id][0] += flow.round_ties_even() as i32;
        }
    }
}
