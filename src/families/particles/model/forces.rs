//! Momenta that the forces of a scene make by themselves, however cold it is.

use std::f64::consts::PI;

use crate::document::{
    AnglesInteraction, BondsInteraction, Chain, LinkSource, NumberedGroup, NumberedSpecies, ParticleGroup, Placement,
    Scene, SpeciesNames,
};
use crate::families::particles::terms;
use crate::families::{PairForce, Species, surroundings};

/// Part of an edge of the box to which integer positions resolve, and some more: springs as long as they should be are off by it.
pub(crate) const RESOLUTION: f64 = 1.0 / (1 << 28) as f64;

/// The largest momentum that a particle is expected to get from potentials; masses beyond `heaviest` count as that.
pub(crate) fn momentum(scene: &Scene, species: &[Species], pair_force: Option<&PairForce>, heaviest: f64) -> f64 {
    let particles = Particles::of(scene, heaviest);
    let of_pairs = pair_force.map_or(0.0, |force| {
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
    scene.interactions().iter().map(terms::of).map(|term| term.momentum(&particles)).fold(of_pairs, f64::max)
}

/// A mass; none of what is held.
fn mobile_mass(mass: f64, fixed: bool, heaviest: f64) -> Option<f64> {
    (!fixed).then_some(mass.min(heaviest))
}

/// The mass that goes with the largest momentum from a force between some particles: that of the heaviest where one is held, else
/// of the second heaviest, for what the heaviest gets the others get too.
fn moved<const LENGTH: usize>(masses: [Option<f64>; LENGTH]) -> f64 {
    let all_move = masses.iter().all(Option::is_some);
    let mut masses = masses.map(|mass| mass.unwrap_or(0.0));
    masses.sort_by(|a, b| b.total_cmp(a));
    masses[usize::from(all_move)]
}

/// Who the particles of a scene are and, where it says so, where they are.
pub(crate) struct Particles<'a> {
    pub scene: &'a Scene,
    groups: Vec<NumberedGroup<'a>>,
    species: NumberedSpecies<'a>,
    /// Masses of the species, by their places; none of what is held.
    masses: Vec<Option<f64>>,
    heaviest: f64,
}

impl<'a> Particles<'a> {
    fn of(scene: &'a Scene, heaviest: f64) -> Self {
        let mass = |name: &&str| {
            let group = scene.particles.iter().find(|group| group.species == **name)?;
            mobile_mass(group.mass, group.is_held(), heaviest)
        };
        Self {
            scene,
            groups: scene.numbered_groups().collect(),
            species: NumberedSpecies::new(scene),
            masses: SpeciesNames::of(scene).names().iter().map(mass).collect(),
            heaviest,
        }
    }

    /// The longest edge of the box.
    pub(crate) fn longest_edge(&self) -> f64 {
        self.scene.space.lengths.iter().copied().fold(0.0, f64::max)
    }

    /// The mass of the heaviest species that can move.
    pub(crate) fn heaviest_mobile(&self) -> f64 {
        self.masses.iter().flatten().copied().fold(0.0, f64::max)
    }

    /// The group of a particle.
    fn group_of(&self, particle: u32) -> Option<NumberedGroup<'a>> {
        let number = u64::from(particle);
        let after = self.groups.partition_point(|numbered| numbered.first <= number);
        self.groups[..after].last().copied().filter(|numbered| number - numbered.first < numbered.count)
    }

    /// The mass of a species, by its place.
    fn mass_of_species(&self, place: usize) -> Option<f64> {
        self.masses.get(place).copied().flatten()
    }

    fn mass_of(&self, particle: u32) -> Option<f64> {
        self.species.of(particle).and_then(|place| self.mass_of_species(place))
    }

    /// Groups of chains of some species, of all where none are named, with their masses.
    fn chains(&self, named: Option<&[String]>) -> impl Iterator<Item = (NumberedGroup<'a>, &'a Chain, f64)> {
        let chained = self.scene.chained_groups(named).filter(|(numbered, _)| numbered.count > 0);
        chained.filter_map(|(numbered, chain)| {
            let mass = mobile_mass(numbered.group.mass, numbered.group.is_held(), self.heaviest)?;
            Some((numbered, chain, mass))
        })
    }

    /// The mass that angles move.
    pub(crate) fn mass_of_angles(&self, angles: &AnglesInteraction) -> f64 {
        let of_triple = |triple: &[u32; 3]| moved(triple.map(|particle| self.mass_of(particle)));
        match angles.links(self.scene).source(self.scene) {
            LinkSource::Listed(triples) => triples.iter().map(of_triple).fold(0.0, f64::max),
            LinkSource::Start(all) => all.iter().flat_map(|links| &links.members).map(of_triple).fold(0.0, f64::max),
            LinkSource::Chains(named) => self.chains(named).map(|(_, _, mass)| mass).fold(0.0, f64::max),
        }
    }

    /// The largest momentum that bonds of a stiffness, a length at rest and an extent give.
    pub(crate) fn momentum_of_bonds(&self, bonds: &BondsInteraction, stiffness: f64, length: f64, extent: f64) -> f64 {
        let least = RESOLUTION * self.longest_edge();
        let of = |(mass, extension): (f64, f64)| mass.sqrt() * extension.min(extent).max(least);
        stiffness.sqrt() * self.starts(bonds, length).into_iter().map(of).fold(0.0, f64::max)
    }

    /// The masses that bonds of a length at rest move, and how far off that length they start: of those that start
    /// alike, one.
    fn starts(&self, bonds: &BondsInteraction, length: f64) -> Vec<(f64, f64)> {
        // Half a box from each other on every axis, or in the same place.
        let farthest = 0.5 * self.scene.space.lengths.iter().map(|edge| edge * edge).sum::<f64>().sqrt();
        let off = |distance: Option<f64>| {
            distance.map_or((farthest - length).max(length), |distance| (distance - length).abs())
        };
        match bonds.links(self.scene).source(self.scene) {
            LinkSource::Start(all) => {
                let of_span = |((a, b), span): (&(u8, u8), &[f64; 2])| {
                    let mass = moved([*a, *b].map(|place| self.mass_of_species(place.into())));
                    (mass, span.iter().map(|distance| off(Some(*distance))).fold(0.0, f64::max))
                };
                all.iter().flat_map(|links| &links.spans).map(of_span).collect()
            }
            LinkSource::Chains(named) => {
                let of_chains = self.chains(named).map(|(numbered, chain, mass)| {
                    let spacings = self.spacings(numbered.count, numbered.group, chain);
                    (mass, spacings.into_iter().map(off).fold(0.0, f64::max))
                });
                of_chains.collect()
            }
            LinkSource::Listed(pairs) => {
                let of_pair = |ends: &[u32; 2]| {
                    let [a, b] = ends.map(|end| self.position(end));
                    let distance = a.zip(b).map(|(a, b)| self.distance(&a, &b));
                    (moved(ends.map(|end| self.mass_of(end))), off(distance))
                };
                pairs.iter().map(of_pair).collect()
            }
        }
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
        let NumberedGroup { group, first, count } = self.group_of(particle)?;
        group.placement.position(u64::from(particle) - first, count)
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
