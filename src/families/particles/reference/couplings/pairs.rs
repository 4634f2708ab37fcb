//! Pairs: the soft repulsion, and a bath coupled to φ(r) with φ' = √ω, constant beyond the cutoff.
//!
//! What a bath with memory needs of the step before is e s - c φ, c = λₑ(1 + e)/2: the pair keeps that one number and
//! the step it belongs to. Out of reach φ is zero, and nothing is done until the pair meets again.

use super::bath::{self, BathSums};
use super::motion::Motion;
use crate::families::particles::reference::cotter_reich::coupling;
use crate::families::particles::reference::pairs::{self, Forces, Pair, find_pairs};
use crate::families::{BathStep, Model, PairForce};
use crate::noise::{self, stream};
use crate::state::{PairBath, State};

/// The bath step of two particles.
pub(super) fn bath_step(model: &Model, force: &PairForce, state: &State, first: usize, second: usize) -> BathStep {
    force.bath_step(state.species[first] as usize, state.species[second] as usize, model.time_step)
}

/// Adds the half kicks of all pairs, advances the baths of the list, and gives Σ r·F.
pub(super) fn kick(
    model: &Model,
    force: &PairForce,
    state: &State,
    motion: &Motion,
    baths: &mut [PairBath],
    kick: &mut [[i64; 3]],
    bath_sums: &mut BathSums,
) -> f64 {
    let mut virial = 0.0;
    let mut add = |pair: &Pair, magnitude: f64| {
        let impulse = pair.direction().map(|component| 0.5 * model.time_step * magnitude * component);
        pairs::exchange(kick, pair, impulse, model.units.momentum);
        virial += pair.distance * magnitude;
    };
    let key = noise::step_key(model.seed, stream::PAIR, state.step);
    if !force.remembers() {
        let excluded = excluded_pairs(model);
        for pair in find_pairs(&model.units, &state.positions, force.cutoff) {
            let forces = Forces::between(model, &state.species, &pair);
            let spared = excluded.binary_search(&[pair.first as u32, pair.second as u32]).is_ok();
            let mut magnitude = if spared { 0.0 } else { forces.potential.force() };
            if forces.friction > 0.0 {
                let step = bath_step(model, force, state, pair.first, pair.second);
                let change = motion.approach(&pair).map_or_else(
                    || phi(force, pair.distance) - phi(force, motion.distance_before(&pair)),
                    |approach| forces.weight * approach,
                );
                // The noise of a pair pushes it apart, as in every other scheme; that of its bath would pull.
                let noise = -pairs::noise(model, key, &pair);
                magnitude -= forces.weight * bath::advanced(&step, force.temperature, 0.0, change, noise);
            }
            add(&pair, magnitude);
        }
        return virial;
    }
    for memory in baths {
        let (first, second) = (memory.first as usize, memory.second as usize);
        let separation = model.units.displacement(state.positions[first], state.positions[second]);
        let distance = pairs::dot(separation, separation).sqrt();
        if distance >= force.cutoff {
            continue;
        }
        let pair = Pair { first, second, separation, distance };
        let step = bath_step(model, force, state, first, second);
        let gaussian = noise::gaussian(noise::words(model.generator, key, [memory.first, memory.second]));
        let steps = (state.step as u32).wrapping_sub(memory.stamp);
        let remembered = f64::from(f32::from_bits(memory.memory));
        // At step 0 the pair has always been where it is, and its bath is at rest.
        let change = if state.step == 0 { 0.0 } else { phi(force, distance) };
        let value = bath::recalled(&step, force.temperature, remembered, steps, change, gaussian);
        let kept = step.persistence * value - step.response() * phi(force, distance);
        (memory.memory, memory.stamp) = ((kept as f32).to_bits(), state.step as u32);
        let forces = Forces::between(model, &state.species, &pair);
        let repulsion = if memory.spared == 1 { 0.0 } else { forces.potential.force() };
        add(&pair, repulsion - forces.weight * value);
        bath_sums.add(&step, value);
    }
    virial
}

/// φ(r): zero from the cutoff on.
fn phi(force: &PairForce, distance: f64) -> f64 {
    coupling(distance, force.cutoff, force.weight_exponent)
}

/// The pairs that are spared their repulsion, smaller number first, in order.
pub(super) fn excluded_pairs(model: &Model) -> Vec<[u32; 2]> {
    let Some(bonds) = model.bonds() else { return Vec::new() };
    let excluding = bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion);
    let mut excluded: Vec<_> =
        excluding.map(|bond| [bond.ends[0].min(bond.ends[1]), bond.ends[0].max(bond.ends[1])]).collect();
    excluded.sort_unstable();
    excluded
}
