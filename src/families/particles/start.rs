//! How particles start, once their places and momenta are known: at rest together, and with variables of baths.

use super::plan::walls;
use crate::document::{BondPotential, Interaction, Problems, Scene};
use crate::families::start::bring_to_rest;
use crate::families::{BathStep, Model, Particles};
use crate::noise::{self, stream};
use crate::state::{Account, State, WallImpulse, sheared_copy};
use std::collections::HashSet;

/// Gives particles at their places what they start with.
pub(super) fn complete(particles: &Particles, state: &mut State, model: &Model, thermal: &[usize]) {
    if let Some(chains) = &particles.chains {
        return chains.fill(state, &model.units, model.seed);
    }
    if model.exchanges_momentum() {
        let masses: Vec<f64> = state.species.iter().map(|species| model.species[*species as usize].mass).collect();
        bring_to_rest(state, thermal, model.units.dimension, |id| masses[id]);
    }
    draw_position_baths(state, model);
    draw_bond_baths(state, model);
    if let Some(noise) = &particles.coloured_noise {
        state.holds = noise.first_holds(model, state.len());
    }
    if particles.tether.is_none() {
        state.tethers = Vec::new();
    } else if state.tethers.is_empty() {
        state.tethers.clone_from(&state.positions);
    }
    if particles.body_forces.is_some() {
        state.account = vec![Account::default()];
    }
    state.walls = vec![WallImpulse::default(); walls::count(model)];
    if let Some(shear) = &particles.shear {
        for &id in thermal {
            let flow = shear.flow(state.species[id] as usize, state.positions[id][shear.gradient], model);
            state.momenta[id][0] += flow.round_ties_even() as i32;
        }
    }
}

/// Draws the bath variables of all coordinates from their law at rest.
fn draw_position_baths(state: &mut State, model: &Model) {
    let Some(bath) = model.particles().position_bath.as_ref().filter(|bath| bath.memory) else { return };
    let key = noise::step_key(model.seed, stream::PARTICLE, 0);
    let draw = |id: usize, axis: usize| {
        let width = bath.steps[state.species[id] as usize].deviation(bath.temperature);
        let words = noise::words(model.generator, key, [id as u32, axis as u32]);
        if axis < model.units.dimension { (width * noise::gaussian(words)) as f32 } else { 0.0 }
    };
    let all = (0..state.len()).map(|id| std::array::from_fn(|axis| draw(id, axis).to_bits()));
    state.position_baths = all.collect();
}

/// Draws the bath variables of all bonds from their law at rest. Bonds without memory beside others have a zero.
fn draw_bond_baths(state: &mut State, model: &Model) {
    let Some(bonds) = model.particles().bonds.as_ref().filter(|bonds| bonds.have_memory()) else { return };
    let key = noise::step_key(model.seed, stream::BOND, 0);
    let all = bonds.iter().enumerate().map(|(index, bond)| {
        let kind = &bonds.kinds[bond.kind as usize];
        let width = kind.bath.filter(BathStep::remembers).map_or(0.0, |step| step.deviation(kind.temperature));
        let words = noise::words(model.generator, key, [index as u32, 1]);
        ((width * noise::gaussian(words)) as f32).to_bits()
    });
    state.bond_baths = all.collect();
}

/// A bond of finite extent cannot start longer than it can be.
pub(super) fn check_extents(scene: &Scene, model: &Model, state: &State, problems: &mut Problems) {
    let Some(bonds) = model.particles().bonds.as_ref() else { return };
    let finite = |kind: u32| match bonds.kinds[kind as usize].potential {
        Some(BondPotential::Fene { extent, length, .. }) => Some((extent, length)),
        _ => None,
    };
    if (0..bonds.kinds.len()).all(|kind| finite(kind as u32).is_none()) {
        return;
    }
    let places: Vec<usize> = (0..scene.interactions.len())
        .filter(|index| matches!(scene.interactions[*index], Interaction::Bonds(_)))
        .collect();
    let mut reported = HashSet::new();
    for bond in bonds.iter() {
        let Some((extent, length)) = finite(bond.kind) else { continue };
        let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
        let b = match &model.particles().shear {
            Some(shear) => sheared_copy(a, b, (shear.gradient, shear.shift(model.clock(0).wrapping_mul(2)))),
            None => b,
        };
        let distance = model.units.displacement(a, b).iter().map(|part| part * part).sum::<f64>().sqrt();
        if (distance - length).abs() >= extent && reported.insert(bond.kind) {
            let found = format!(
                "{extent}, and a distance of {distance:.6} between particles {} and {} at the start",
                bond.ends[0], bond.ends[1]
            );
            let accepted = format!(
                "more than {:.6}, by which that bond starts off its length {length}; or a start with shorter bonds",
                (distance - length).abs()
            );
            problems.refuse(format!("interactions[{}].potential.extent", places[bond.kind as usize]), found, accepted);
        }
    }
}
