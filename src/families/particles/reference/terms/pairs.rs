//! Pairs with memory: the soft repulsion, and a bath coupled to φ(r) with φ' = √ω, constant beyond the cutoff.
//!
//! What a bath with memory needs of the step before is e s - c φ, c = λₑ(1 + e)/2: the pair keeps that one number and
//! the step it belongs to. Out of reach φ is zero, and nothing is done until the pair meets again.

use crate::families::particles::reference::leapfrog::coupling;
use crate::families::particles::reference::pairs::{self, Forces, Pair};
use crate::families::particles::reference::shear::Images;
use crate::families::particles::reference::stress::Virials;
use crate::families::reference::bath::{self, BathSums};
use crate::families::{Model, PairForce};
use crate::noise::{self, stream};
use crate::state::{PairBath, State};

/// Adds the half kicks of listed pairs and their virials, and advances the baths of the list.
pub(in crate::families::particles::reference) fn kick(
    (model, force): (&Model, &PairForce),
    state: &State,
    baths: &mut [PairBath],
    kick: &mut [[i64; 3]],
    bath_sums: &mut BathSums,
    virials: &mut Virials,
) {
    let images = Images::of_step(model, state.step);
    let key = noise::step_key(model.seed, stream::PAIR, model.clock(state.step));
    for memory in baths {
        let (first, second) = (memory.first as usize, memory.second as usize);
        let pair = Pair::of(&images, &state.positions, first, second);
        if pair.distance >= force.cutoff {
            continue;
        }
        let species = [first, second].map(|end| state.species[end] as usize);
        let step = force.bath_step(species[0], species[1], model.time_step);
        let gaussian = noise::gaussian(noise::words(model.generator, key, [memory.first, memory.second]));
        let steps = (model.clock(state.step) as u32).wrapping_sub(memory.stamp);
        let remembered = f64::from(f32::from_bits(memory.memory));
        // At step 0 the pair has always been where it is, and its bath is at rest.
        let coupled = coupling(force, species, pair.distance);
        let change = if model.clock(state.step) == 0 { 0.0 } else { coupled };
        let value = bath::recalled(&step, force.temperature, remembered, steps, change, gaussian);
        let kept = step.persistence * value - step.response() * coupled;
        (memory.memory, memory.stamp) = ((kept as f32).to_bits(), model.clock(state.step) as u32);
        let forces = Forces::between(model, &state.species, &pair);
        let repulsion = if memory.spared == 1 { 0.0 } else { forces.potential.force() };
        pairs::push_apart(model, &pair, repulsion - forces.weight * value, kick);
        virials.add(&pair, repulsion, -forces.weight * value);
        bath_sums.add(&step, value);
    }
}

/// The pairs that are spared their repulsion, smaller number first, in order.
pub(in crate::families::particles::reference) fn excluded_pairs(model: &Model) -> Vec<[u32; 2]> {
    let Some(bonds) = model.particles().bonds.as_ref() else { return Vec::new() };
    let excluding = bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion);
    let mut excluded: Vec<_> =
        excluding.map(|bond| [bond.ends[0].min(bond.ends[1]), bond.ends[0].max(bond.ends[1])]).collect();
    excluded.sort_unstable();
    excluded
}
