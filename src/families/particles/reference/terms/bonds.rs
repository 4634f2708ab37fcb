//! Bonds: a potential of the length, and a bath coupled to it, h = |rᵢ - rⱼ|.

use crate::families::particles::reference::motion::Motion;
use crate::families::particles::reference::pairs::{self, Pair};
use crate::families::particles::reference::potential::Potential;
use crate::families::particles::reference::shear::Images;
use crate::families::particles::reference::stress::Virials;
use crate::families::reference::Unstable;
use crate::families::reference::bath::{self, BathSums};
use crate::families::{Bond, Bonds, Model};
use crate::noise::{self, stream};
use crate::state::State;

/// The ends of a bond where they are.
pub(in crate::families::particles::reference) fn span(
    images: &Images<'_>,
    bond: &Bond,
    positions: &[[u32; 3]],
) -> Pair {
    let [first, second] = bond.ends.map(|end| end as usize);
    Pair::of(images, positions, first, second)
}

/// Adds the half kicks of all bonds and their virials, and returns the bath variables after the step, where bonds remember.
pub(in crate::families::particles::reference) fn kick(
    model: &Model,
    bonds: &Bonds,
    state: &State,
    motion: &Motion,
    kick: &mut [[i64; 3]],
    bath_sums: &mut BathSums,
    virials: &mut Virials,
) -> Result<Vec<u32>, Unstable> {
    let key = noise::step_key(model.seed, stream::BOND, model.clock(state.step));
    let images = Images::of_step(model, state.step);
    let mut baths = state.bond_baths.clone();
    for (index, bond) in bonds.iter().enumerate() {
        let kind = &bonds.kinds[bond.kind as usize];
        let pair = span(&images, &bond, &state.positions);
        let Some(potential) = Potential::of_bond(kind.potential.as_ref(), pair.distance) else {
            return Err(Unstable::Bond { step: state.step, bond: index });
        };
        let mut friction = 0.0;
        // Where steps are split, velocities along bonds relax in O.
        if let Some(step) = kind.bath.as_ref().filter(|_| !model.particles().relaxes_bonds(model)) {
            let gaussian = noise::gaussian(noise::words(model.generator, key, [index as u32, 0]));
            let change = if step.remembers() {
                motion.change_of_distance(&pair)
            } else {
                motion.approach(&pair).unwrap_or_else(|| motion.drift_of_distance(&pair))
            };
            let kept = baths.get_mut(index);
            let value = bath::at_report(step, kind.temperature, model.clock(state.step), kept, change, gaussian);
            bath_sums.add(step, value);
            friction = -value;
        }
        pairs::push_apart(model, &pair, potential.force() + friction, kick);
        virials.add(&pair, potential.force(), friction);
    }
    Ok(baths)
}
