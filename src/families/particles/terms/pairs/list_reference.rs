//! Which pairs have a bath that remembers: those on a list of all pairs within the cutoff and a skin.
//!
//! The list is rebuilt when some particle is further than half the skin from where it was when the list was made, its
//! *anchor*. A pair on both lists keeps what its bath remembers. Beyond the cutoff the coupling function is
//! constant, so that a bath follows the law at rest after some time there: a pair that is new to the list draws from it.

use super::PairForce;
use crate::families::Model;
use crate::families::particles::reference::{Moment, dot, find_pairs};
use crate::families::particles::terms::bonds::reference::excluded_pairs;
use crate::noise::{self, stream};
use crate::state::{PairBath, State};

/// The baths of the list and the anchors that hold at the current step.
pub(super) fn renew(force: &PairForce, moment: &Moment<'_>) -> (Vec<PairBath>, Vec<[u32; 3]>) {
    let (model, state, images) = (moment.model, moment.state, &moment.images);
    let reach = force.reach_in_list(model).powi(2);
    let is_far = |(position, anchor): (&[u32; 3], &[u32; 3])| {
        let (way, _) = images.displacement(*position, *anchor);
        dot(way, way) > reach
    };
    // Images go on without their particles: their pairs are listed again when boundaries have moved a part of the skin.
    let outdated = model.particles().shear.is_some_and(|shear| {
        let halves = model.clock(state.step).wrapping_mul(2);
        let [now, before] = [halves, halves.wrapping_sub(2)].map(|halves| shear.shift(halves));
        now / force.margin_of_copies(model) != before / force.margin_of_copies(model)
    });
    let listed = state.anchors.len() == state.len();
    if listed && !outdated && !state.positions.iter().zip(&state.anchors).any(is_far) {
        return (state.pair_baths.clone(), state.anchors.clone());
    }
    let key = noise::step_key(model.seed, stream::PAIR_START, model.clock(state.step));
    let excluded = excluded_pairs(model);
    let pairs = find_pairs(images, &state.positions, force.cutoff + force.skin);
    let mut numbers: Vec<[u32; 2]> = pairs.iter().map(|pair| [pair.first as u32, pair.second as u32]).collect();
    numbers.sort_unstable();
    let mut known = state.pair_baths.iter().peekable();
    let listed = numbers.into_iter().map(|numbers| {
        while known.next_if(|bath| [bath.first, bath.second] < numbers).is_some() {}
        let bath = match known.next_if(|bath| [bath.first, bath.second] == numbers) {
            Some(bath) => *bath,
            None => fresh(model, force, state, key, numbers),
        };
        PairBath { spared: excluded.binary_search(&numbers).is_ok().into(), ..bath }
    });
    (listed.collect(), state.positions.clone())
}

/// A bath that was at rest one step ago, when the pair was out of reach: s = √(kTλₑ) ζ and h = 0.
fn fresh(model: &Model, force: &PairForce, state: &State, key: [u32; 2], [first, second]: [u32; 2]) -> PairBath {
    let step = force.bath_step(
        state.species[first as usize] as usize,
        state.species[second as usize] as usize,
        model.time_step,
    );
    let value =
        step.deviation(force.temperature) * noise::gaussian(noise::words(model.generator, key, [first, second]));
    let memory = (step.persistence * value) as f32;
    PairBath {
        first,
        second,
        memory: memory.to_bits(),
        stamp: (model.clock(state.step) as u32).wrapping_sub(1),
        spared: 0,
    }
}
