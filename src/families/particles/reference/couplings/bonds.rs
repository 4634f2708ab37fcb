//! Bonds: a potential of the length, and a bath coupled to it, h = |rᵢ - rⱼ|.

use super::bath::{self, BathSums};
use super::motion::Motion;
use crate::families::particles::reference::pairs::{self, Pair};
use crate::families::particles::reference::potential::Potential;
use crate::families::reference::Unstable;
use crate::families::{Bond, Bonds, Model};
use crate::noise::{self, stream};
use crate::state::State;

/// What the bonds of a step leave.
pub(super) struct Bonded {
    /// Bath variables, where bonds remember.
    pub baths: Vec<u32>,
    /// Σ r·F of all forces.
    pub virial: f64,
}

/// The ends of a bond where they are.
pub(super) fn span(model: &Model, bond: &Bond, positions: &[[u32; 3]]) -> Pair {
    let [first, second] = bond.ends.map(|end| end as usize);
    let separation = model.units.displacement(positions[first], positions[second]);
    Pair { first, second, separation, distance: pairs::dot(separation, separation).sqrt() }
}

/// Adds the half kicks of all bonds and advances their baths.
pub(super) fn kick(
    model: &Model,
    bonds: &Bonds,
    state: &State,
    motion: &Motion,
    kick: &mut [[i64; 3]],
    bath_sums: &mut BathSums,
) -> Result<Bonded, Unstable> {
    let key = noise::step_key(model.seed, stream::BOND, state.step);
    let mut found = Bonded { baths: state.bond_baths.clone(), virial: 0.0 };
    for (index, bond) in bonds.iter().enumerate() {
        let kind = &bonds.kinds[bond.kind as usize];
        let pair = span(model, &bond, &state.positions);
        let Some(potential) = Potential::of_bond(kind.potential.as_ref(), pair.distance) else {
            return Err(Unstable::Bond { step: state.step, bond: index });
        };
        let mut force = potential.force();
        if let Some(step) = &kind.bath {
            let gaussian = noise::gaussian(noise::words(model.generator, key, [index as u32, 0]));
            let value = if step.remembers() {
                let before = f64::from(f32::from_bits(state.bond_baths[index]));
                let value = match state.step {
                    0 => before,
                    _ => bath::advanced(step, kind.temperature, before, motion.change_of_distance(&pair), gaussian),
                };
                found.baths[index] = (value as f32).to_bits();
                bath_sums.add(step, value);
                value
            } else {
                let change = motion.approach(&pair).unwrap_or_else(|| motion.change_of_distance(&pair));
                bath::advanced(step, kind.temperature, 0.0, change, gaussian)
            };
            force -= value;
        }
        let impulse = pair.direction().map(|component| 0.5 * model.time_step * force * component);
        pairs::exchange(kick, &pair, impulse, model.units.momentum);
        found.virial += pair.distance * force;
    }
    Ok(found)
}
