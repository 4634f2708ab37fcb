//! Momenta that the forces of a scene make by themselves, however cold it is.

use std::collections::HashSet;
use std::f64::consts::PI;

use super::{PairForce, surroundings};
use crate::document::{
    AnglesInteraction, BondPotential, BondsInteraction, Chain, FileLinks, Interaction, ParticleGroup, Placement, Scene,
    SpeciesNames,
};
use crate::families::Species;

/// Part of an edge of the box to which integer positions resolve, and some more: springs as long as they should be are off by it.
const RESOLUTION: f64 = 1.0 / (1 << 28) as f64;

/// The largest momentum that a particle is expected to get from potentials; masses beyond `heaviest` count as that.
pub(crate) fn momentum(scene: &Scene, species: &[Species], pair_force: Option<&PairForce>, heaviest: f64) -> f64 {
    let particles = Particles::of(scene, heaviest);
    let longest = scene.space.lengths.iter().copied().fold(0.0, f64::max);
    let mut most = pair_force.map_or(0.0, |force| {
        let mass = |a: usize| mobile_mass(species[a].mass, species[a].fixed, heaviest);
        let squares = (0..species.len()).flat_map(|a| (a..species.len()).map(move |b| [a, b]));
        let squares = squares.map(|[a, b]| moved([mass(a), mass(b)]) * force.energy_between(a, b));
        let of_pairs = squares.fold(0.0, f64::max).sqrt();
        // Of a crowd all forces of half a step have to fit, though most of them cancel.
        of_pairs.max(force.many_body.map_or(0.0, |many_body| {
            let in_box = species.iter().map(|species| species.count).sum::<u64>() as f64 / scene.space.volume();
            let around = surroundings::of(scene, species, force).map_or(0.0, |around| around.largest());
            0.5 * scene.time.step * many_body.strain(in_box.max(around))
        }))
    });
    for interaction in &scene.interactions {
        most = most.max(match interaction {
            Interaction::Tether(spring) => {
                (particles.heaviest_mobile() * spring.stiffness).sqrt() * RESOLUTION * longest
            }
            // From a sharp bend to a straight chain.
            Interaction::Angles(angles) => 2.0 * (particles.bent(angles) * angles.stiffness.abs()).sqrt(),
            Interaction::Bonds(bonds) => {
                let spring = |stiffness: f64, length: f64, extent: f64| {
                    let of = |start: Start| start.mass.sqrt() * start.extension.min(extent).max(RESOLUTION * longest);
                    stiffness.sqrt() * particles.starts(bonds, length).into_iter().map(of).fold(0.0, f64::max)
                };
                match bonds.potential {
                    None => 0.0,
                    Some(BondPotential::Harmonic { stiffness, length }) => spring(stiffness, length, f64::INFINITY),
                    // Near its end the force grows beyond that of the spring.
                    Some(BondPotential::Fene { stiffness, extent, length }) => 2.0 * spring(stiffness, length, extent),
                }
            }
            _ => 0.0,
        });
    }
    most
}

/// A mass; none of what is held.
fn mobile_mass(mass: f64, fixed: bool, heaviest: f64) -> Option<f64> {
    (!fixed).then_some(mass.min(heaviest))
}

/// The mass that goes with the largest momentum from a force between some particles: that of the heaviest where one is held, else
/// of the second heaviest, for what the heaviest gets the others get too.
fn moved<const LENGTH: usize>(masses: [Option<f64>; LENGTH]) -> f64 {
    let mut mobile: Vec<f64> = masses.into_iter().flatten().collect();
    mobile.sort_by(|a, b| b.total_cmp(a));
    mobile.get(usize::from(mobile.len() == LENGTH)).copied().unwrap_or(0.0)
}

/// How a bond starts: off its length at rest, and the mass that it moves.
struct Start {
    mass: f64,
    extension: f64,
}

/// Who the particles of a scene are and, where it says so, where they are.
struct Particles<'a> {
    scene: &'a Scene,
    /// Groups with the number of their first particle and of their particles.
    groups: Vec<(u64, u64, &'a ParticleGroup)>,
    /// Masses of the species, by their places; none of what is held.
    masses: Vec<Option<f64>>,
    heaviest: f64,
}

impl<'a> Particles<'a> {
    fn of(scene: &'a Scene, heaviest: f64) -> Self {
        let mut first = 0_u64;
        let mut groups = Vec::with_capacity(scene.particles.len());
        for group in &scene.particles {
            let count = group.resolved_count(&scene.space);
            groups.push((first, count, group));
            first = first.saturating_add(count);
        }
        let mass = |name: &&str| {
            let group = scene.particles.iter().find(|group| group.species == **name)?;
            mobile_mass(group.mass, group.is_held(), heaviest)
        };
        let masses = SpeciesNames::of(scene).names().iter().map(mass).collect();
        Self { scene, groups, masses, heaviest }
    }

    fn mass(&self, group: &ParticleGroup) -> Option<f64> {
        mobile_mass(group.mass, group.is_held(), self.heaviest)
    }

    fn heaviest_mobile(&self) -> f64 {
        self.groups.iter().filter_map(|(_, _, group)| self.mass(group)).fold(0.0, f64::max)
    }

    /// The group of a particle, and its number there.
    fn group_of(&self, particle: u32) -> Option<(u64, u64, &'a ParticleGroup)> {
        let number = u64::from(particle);
        let after = self.groups.partition_point(|(first, ..)| *first <= number);
        let (first, count, group) = self.groups[..after].last()?;
        (number - first < *count).then_some((number - first, *count, *group))
    }

    /// The mass of a species, by its place.
    fn mass_of_species(&self, place: usize) -> Option<f64> {
        self.masses.get(place).copied().flatten()
    }

    fn mass_of(&self, particle: u32) -> Option<f64> {
        if let Some(start) = self.scene.start() {
            return start.species_of(particle).and_then(|place| self.mass_of_species(place));
        }
        self.group_of(particle).and_then(|(_, _, group)| self.mass(group))
    }

    /// Groups of chains of some species; of all where none are named.
    fn chains(&self, named: Option<&[String]>) -> impl Iterator<Item = (u64, &'a ParticleGroup, &'a Chain)> {
        let asked = move |group: &ParticleGroup| named.is_none_or(|names| names.contains(&group.species));
        self.groups.iter().filter_map(move |(_, count, group)| {
            let chain = group.chain.as_ref()?;
            (asked(group) && *count > 0).then_some((*count, *group, chain))
        })
    }

    /// The mass that angles move.
    fn bent(&self, angles: &AnglesInteraction) -> f64 {
        let of_triple = |triple: &[u32; 3]| moved(triple.map(|particle| self.mass_of(particle)));
        if angles.triples.is_empty() && self.scene.links_are_from_file(angles.types.as_deref()) {
            self.scene.file_angles(angles.types.as_deref()).map(|links| self.heaviest_of(links)).fold(0.0, f64::max)
        } else if angles.triples.is_empty() {
            let masses = self.chains(angles.species.as_deref()).filter_map(|(_, group, _)| self.mass(group));
            masses.fold(0.0, f64::max)
        } else {
            angles.triples.iter().map(of_triple).fold(0.0, f64::max)
        }
    }

    /// The largest mass that angles of a file move.
    fn heaviest_of(&self, links: &FileLinks<3>) -> f64 {
        let kinds: HashSet<[Option<usize>; 3]> = match self.scene.start() {
            Some(start) => links.members.iter().map(|members| members.map(|member| start.species_of(member))).collect(),
            None => HashSet::new(),
        };
        let mass = |place: Option<usize>| place.and_then(|place| self.mass_of_species(place));
        kinds.into_iter().map(|kinds| moved(kinds.map(mass))).fold(0.0, f64::max)
    }

    /// How bonds of a length at rest start: of those that start alike, one.
    fn starts(&self, bonds: &BondsInteraction, length: f64) -> Vec<Start> {
        // Half a box from each other on every axis, or in the same place.
        let farthest = 0.5 * self.scene.space.lengths.iter().map(|edge| edge * edge).sum::<f64>().sqrt();
        let off = |distance: Option<f64>| {
            distance.map_or((farthest - length).max(length), |distance| (distance - length).abs())
        };
        if bonds.pairs.is_empty() && self.scene.links_are_from_file(bonds.types.as_deref()) {
            let of_types = self.scene.file_bonds(bonds.types.as_deref()).flat_map(|links| &links.spans);
            let of_span = |((a, b), span): (&(u8, u8), &[f64; 2])| {
                let mass = moved([*a, *b].map(|place| self.mass_of_species(place.into())));
                let extension = span.iter().map(|distance| off(Some(*distance))).fold(0.0, f64::max);
                Start { mass, extension }
            };
            return of_types.map(of_span).collect();
        }
        if bonds.pairs.is_empty() {
            let chains = self.chains(bonds.species.as_deref());
            let of_chains = chains.filter_map(|(count, group, chain)| {
                let mass = self.mass(group)?;
                let extension = self.spacings(count, group, chain).into_iter().map(off).fold(0.0, f64::max);
                Some(Start { mass, extension })
            });
            return of_chains.collect();
        }
        let of_pair = |ends: &[u32; 2]| {
            let mass = moved(ends.map(|end| self.mass_of(end)));
            let [a, b] = ends.map(|end| self.position(end));
            let distance = a.zip(b).map(|(a, b)| self.distance(&a, &b));
            Start { mass, extension: off(distance) }
        };
        bonds.pairs.iter().map(of_pair).collect()
    }

    /// Lengths of the bonds along the chains of a group; none for one that may be any.
    fn spacings(&self, count: u64, group: &ParticleGroup, chain: &Chain) -> Vec<Option<f64>> {
        let beads = chain.beads.max(1) as usize;
        let closed = chain.closed && beads > 2;
        match &group.placement {
            // On a line a ring turns back with bonds of half the spacing.
            Placement::Random | Placement::Lattice { .. } if closed && self.scene.space.lengths.len() == 1 => {
                vec![Some(chain.spacing), Some(0.5 * chain.spacing)]
            }
            Placement::Random | Placement::Lattice { .. } | Placement::BehindWalls { .. } => vec![Some(chain.spacing)],
            Placement::Circle { radius, .. } => {
                let chord = |steps: usize| 2.0 * radius * (PI * steps as f64 / count as f64).sin().abs();
                // A longer one may be met the other way round the box.
                let half = 0.5 * self.scene.space.shortest_length();
                let known = |chord: f64| (chord <= half).then_some(chord);
                let closing = closed.then(|| known(chord(beads - 1)));
                [Some(known(chord(1))), closing].into_iter().flatten().collect()
            }
            Placement::Listed { positions } => {
                let along = positions.chunks(beads).flat_map(|chain| {
                    let closing = closed.then(|| [&chain[0], &chain[chain.len() - 1]]);
                    chain.windows(2).map(|pair| [&pair[0], &pair[1]]).chain(closing)
                });
                along.map(|[a, b]| Some(self.distance(a, b))).collect()
            }
        }
    }

    /// Where a particle starts, if the scene says so.
    fn position(&self, particle: u32) -> Option<[f64; 3]> {
        let (number, count, group) = self.group_of(particle)?;
        match &group.placement {
            Placement::Random | Placement::Lattice { .. } | Placement::BehindWalls { .. } => None,
            Placement::Listed { positions } => {
                let position = positions.get(number as usize)?;
                Some(std::array::from_fn(|axis| position.get(axis).copied().unwrap_or(0.0)))
            }
            Placement::Circle { center, radius } => {
                let (sine, cosine) = (2.0 * PI * number as f64 / count as f64).sin_cos();
                Some([center[0] + radius * cosine, center[1] + radius * sine, 0.0])
            }
        }
    }

    /// The shortest distance of two places.
    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let apart = self.scene.space.lengths.iter().enumerate().map(|(axis, edge)| {
            let [a, b] = [a, b].map(|place| place.get(axis).copied().unwrap_or(0.0));
            (a - b) - edge * ((a - b) / edge).round()
        });
        apart.map(|part| part * part).sum::<f64>().sqrt()
    }
}
