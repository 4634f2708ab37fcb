//! Pairs with memory: the soft repulsion, and a bath coupled to φ(r) with φ' = √ω, constant beyond the cutoff.
//!
//! What a bath with memory needs of the step before is e s - c φ, c = λₑ(1 + e)/2: the pair keeps that one number and
//! the step it belongs to. Out of reach φ is zero, and nothing is done until the pair meets again.

use super::leapfrog::coupling;
use super::{PairForce, list_reference};
use crate::families::particles::reference::{Forces, Kicks, Moment, Pair};
use crate::families::reference::bath;
use crate::noise::{self, stream};

/// Adds the half kicks of listed pairs and their virials, and the list with its baths after the step.
pub(super) fn kick(force: &PairForce, moment: &Moment<'_>, kicks: &mut Kicks) {
    let (model, state) = (moment.model, moment.state);
    let key = noise::step_key(model.seed, stream::PAIR, model.clock(state.step));
    let (mut baths, anchors) = list_reference::renew(force, moment);
    for memory in &mut baths {
        let (first, second) = (memory.first as usize, memory.second as usize);
        let pair = Pair::of(&moment.images, &state.positions, first, second);
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
        kicks.push_apart(model, &pair, repulsion, -forces.weight * value);
        kicks.bath_sums.add(&step, value);
    }
    (kicks.baths.pair_baths, kicks.baths.anchors) = (baths, anchors);
}
