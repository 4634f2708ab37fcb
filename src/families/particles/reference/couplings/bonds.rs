//! Bonds: a potential of the length, and a bath coupled to it, h = |rᵢ - rⱼ|.

use super::bath::{self, BathSums};
use super::motion::Motion;
use crate::families::particles::reference::pairs::{self, Pair};
use crate::families::reference::Unstable;
use crate::families::{Bond, Bonds, Model};
use crate::noise::{self, stream};
use crate::scene::BondPotential;
use crate::state::State;

/// What the bonds of a step leave.
pub(super) struct Bonded {
    /// Bath variables, where bonds remember.
    pub baths: Vec<u32>,
    /// Σ r·F of all forces.
    pub virial: f64,
}

/// V, V' and V'' at a length.
pub(super) struct Potential {
    /// V.
    pub energy: f64,
    /// V'.
    pub slope: f64,
    /// V''.
    pub curvature: f64,
}

impl Potential {
    /// Of a bond of some length; none for a length that is out of reach.
    pub fn at(potential: Option<&BondPotential>, distance: f64) -> Option<Self> {
        match *potential.unwrap_or(&BondPotential::Harmonic { stiffness: 0.0, length: 0.0 }) {
            BondPotential::Harmonic { stiffness, length } => {
                let extension = distance - length;
                Some(Self {
                    energy: 0.5 * stiffness * extension * extension,
                    slope: stiffness * extension,
                    curvature: stiffness,
                })
            }
            BondPotential::Fene { stiffness, extent, length } => {
                let extension = distance - length;
                let square = (extension / extent).powi(2);
                (square < 1.0).then(|| Self {
                    energy: -0.5 * stiffness * extent * extent * (-square).ln_1p(),
                    slope: stiffness * extension / (1.0 - square),
                    curvature: stiffness * (1.0 + square) / (1.0 - square).powi(2),
                })
            }
        }
    }
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
        let Some(potential) = Potential::at(kind.potential.as_ref(), pair.distance) else {
            return Err(Unstable::Bond { step: state.step, bond: index });
        };
        let mut force = -potential.slope;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn potentials_have_their_derivatives() {
        let harmonic = BondPotential::Harmonic { stiffness: 3.0, length: 0.7 };
        let finite = BondPotential::Fene { stiffness: 3.0, extent: 1.5, length: 0.2 };
        for potential in [&harmonic, &finite] {
            for distance in [0.1, 0.7, 1.3, 1.65] {
                let at = |distance| Potential::at(Some(potential), distance).unwrap();
                let (less, more, here) = (at(distance - 1e-5), at(distance + 1e-5), at(distance));
                let slope = (more.energy - less.energy) / 2e-5;
                assert!((slope - here.slope).abs() < 1e-6 * here.slope.abs().max(1.0), "{potential:?} {distance}");
                let curvature = (more.slope - less.slope) / 2e-5;
                assert!((curvature - here.curvature).abs() < 1e-5 * here.curvature, "{potential:?} {distance}");
            }
        }
        // For a small extension both are the same spring.
        let near = Potential::at(Some(&finite), 0.2 + 1e-4).unwrap();
        assert!((near.energy / (0.5 * 3.0 * 1e-8) - 1.0).abs() < 1e-7);
        assert!(Potential::at(Some(&finite), 1.7).is_none());
    }
}
