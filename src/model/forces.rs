//! Momenta that the forces of a scene make by themselves, however cold it is.

use super::PairForce;
use crate::scene::{BondPotential, BondsInteraction, Interaction, Placement, Scene};

/// Part of an edge of the box to which integer positions resolve, and some more: springs as long as they should be are off by it.
const RESOLUTION: f64 = 1.0 / (1 << 28) as f64;

/// The largest momentum that a particle of a mass is expected to get from potentials.
pub(super) fn momentum(scene: &Scene, mass: f64, pair_force: Option<&PairForce>) -> f64 {
    let longest = scene.space.lengths.iter().copied().fold(0.0, f64::max);
    let of_spring = |stiffness: f64, extension: f64| (mass * stiffness).sqrt() * extension.max(RESOLUTION * longest);
    let mut most = pair_force.map_or(0.0, |force| (mass * force.largest_repulsion() * force.cutoff).sqrt());
    for interaction in &scene.interactions {
        most = most.max(match interaction {
            Interaction::Tether(spring) => of_spring(spring.stiffness, 0.0),
            // From a sharp bend to a straight chain.
            Interaction::Angles(angles) => 2.0 * (mass * angles.stiffness).sqrt(),
            Interaction::Bonds(bonds) => match bonds.potential {
                None => 0.0,
                Some(BondPotential::Harmonic { stiffness, length }) => {
                    of_spring(stiffness, extension(scene, bonds, length))
                }
                // Near its end the force grows beyond that of the spring.
                Some(BondPotential::Fene { stiffness, extent, length }) => {
                    2.0 * of_spring(stiffness, extension(scene, bonds, length).min(extent))
                }
            },
            Interaction::Dpd(_)
            | Interaction::Langevin(_)
            | Interaction::ColouredNoise(_)
            | Interaction::HarmonicChain(_)
            | Interaction::ShallowWater(_)
            | Interaction::Voronoi(_) => 0.0,
        });
    }
    most
}

/// How far from their length at rest bonds may start.
fn extension(scene: &Scene, bonds: &BondsInteraction, length: f64) -> f64 {
    let shortest = scene.space.lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let anywhere = (0.5 * shortest - length).max(length);
    if !bonds.pairs.is_empty() {
        return anywhere;
    }
    let chains = scene.particles.iter().filter_map(|group| Some((group.chain.as_ref()?, &group.placement)));
    let off = chains.map(|(chain, placement)| match placement {
        // On a line a ring turns back with bonds of half the spacing.
        Placement::Random | Placement::Lattice { .. } if chain.closed && scene.space.lengths.len() == 1 => {
            (chain.spacing - length).abs().max((0.5 * chain.spacing - length).abs())
        }
        Placement::Random | Placement::Lattice { .. } => (chain.spacing - length).abs(),
        Placement::Listed { .. } | Placement::Circle { .. } => anywhere,
    });
    off.fold(0.0, f64::max)
}
