//! Which particles follow each other along chains: described, however many they are, and listed only where a run needs them.

use super::molecules::{BondedMolecules, molecules};
use crate::document::{Chain, FileLinks, LinkSource, Links, NumberedGroup, Scene, SpeciesNames};
use crate::families::particles::index_of;
use crate::families::{Bonds, Species};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// A bond or an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link<const LENGTH: usize> {
    /// Numbers of the particles; an angle is at the middle one.
    pub ends: [u32; LENGTH],
    /// Index of its kind.
    pub kind: u32,
}

/// A bond.
pub type Bond = Link<2>;
/// An angle.
pub type Angle = Link<3>;

/// The particles that some bonds join, in order.
pub(crate) fn bonded_particles(bonds: &[Bond]) -> Vec<u32> {
    let mut members: Vec<u32> = bonds.iter().flat_map(|bond| bond.ends).collect();
    members.sort_unstable();
    members.dedup();
    members
}

/// Runs of `LENGTH` particles in a row, in order: bonds and angles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Runs<const LENGTH: usize> {
    stretches: Vec<Stretch<LENGTH>>,
}

/// Runs of one kind that one thing describes.
#[derive(Debug, Clone, PartialEq)]
struct Stretch<const LENGTH: usize> {
    kind: u32,
    shape: Shape<LENGTH>,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape<const LENGTH: usize> {
    /// All neighbours along chains of `beads` particles; `starts` runs in each.
    Chains { first: u64, chains: u64, beads: u64, starts: u64, species: usize },
    /// Neighbours along particles from `first` on, between two that are elsewhere.
    Strand { before: u32, first: u32, beads: u32, after: u32, species: usize, end_species: usize },
    /// Particle numbers that the scene lists.
    Listed(Vec<[u32; LENGTH]>),
    /// What is in a file, and in copies of it.
    File(Arc<FileLinks<LENGTH>>),
}

/// What some runs of a kind have in common: the species of their particles, or the particles themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alike<'a, const LENGTH: usize> {
    /// Runs of particles of one species.
    Species(usize),
    /// Runs of particles of one species, one of which at each end is of another.
    Ended(usize, usize),
    /// Particle numbers.
    Listed(&'a [[u32; LENGTH]]),
}

impl<const LENGTH: usize> Runs<LENGTH> {
    /// Adds links from wherever they come.
    pub(crate) fn add(&mut self, kind: u32, links: &Links<'_, LENGTH>, scene: &Scene, species: &[Species]) {
        let shapes: Vec<Shape<LENGTH>> = match links.source(scene) {
            LinkSource::Listed(listed) => vec![Shape::Listed(listed.to_vec())],
            LinkSource::Start(links) => links.into_iter().map(|links| Shape::File(Arc::clone(links))).collect(),
            LinkSource::Chains(named) => {
                let shape = |(numbered, chain): (NumberedGroup<'_>, &Chain)| Shape::Chains {
                    first: numbered.first,
                    chains: numbered.chains(),
                    beads: numbered.beads(),
                    starts: chain.links(LENGTH as u64),
                    species: index_of(species, &numbered.group.species).unwrap_or(0),
                };
                scene.chained_groups(named).map(shape).collect()
            }
        };
        self.stretches.extend(shapes.into_iter().map(|shape| Stretch { kind, shape }));
    }

    /// Number of runs.
    pub(crate) fn count(&self) -> u64 {
        self.count_of(|_| true)
    }

    /// Number of runs of some kinds.
    pub(crate) fn count_of(&self, asked: impl Fn(u32) -> bool) -> u64 {
        let stretches = self.stretches.iter().filter(|stretch| asked(stretch.kind));
        stretches.fold(0, |sum, stretch| sum.saturating_add(stretch.shape.count()))
    }

    /// All runs with their kinds, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Link<LENGTH>> {
        self.stretches.iter().flat_map(|stretch| {
            (0..stretch.shape.count()).map(|index| Link { ends: stretch.shape.run(index), kind: stretch.kind })
        })
    }

    /// Kinds and what their runs have in common.
    pub(crate) fn alike(&self) -> impl Iterator<Item = (u32, Alike<'_, LENGTH>)> {
        let of_some = |stretch: &&Stretch<LENGTH>| stretch.shape.count() > 0;
        self.stretches.iter().filter(of_some).map(|stretch| (stretch.kind, stretch.shape.alike()))
    }
}

impl Runs<2> {
    /// Adds the neighbours along `beads` particles from `first` on, and those of its ends with two particles elsewhere.
    pub(crate) fn add_strand(
        &mut self,
        kind: u32,
        [before, after]: [u32; 2],
        first: u32,
        beads: u32,
        species: [usize; 2],
    ) {
        let [species, end_species] = species;
        self.stretches
            .push(Stretch { kind, shape: Shape::Strand { before, first, beads, after, species, end_species } });
    }

    /// The largest number of different partners that a particle has in runs of some kinds.
    pub(crate) fn most_partners(&self, asked: impl Fn(u32) -> bool) -> usize {
        let mut most = 0;
        let mut listed = HashSet::new();
        // Groups of chains by their first particle: chains, beads, and whether they are closed.
        let mut groups: BTreeMap<u64, [u64; 3]> = BTreeMap::new();
        for stretch in self.stretches.iter().filter(|stretch| asked(stretch.kind)) {
            match &stretch.shape {
                Shape::Chains { first, chains, beads, starts, .. } => {
                    if chains * starts > 0 {
                        most = most.max((*starts).min(2) as usize);
                        let group = groups.entry(*first).or_insert([*chains, *beads, 0]);
                        group[2] = group[2].max(u64::from(starts == beads));
                    }
                }
                Shape::Strand { beads, .. } => most = most.max(if *beads > 0 { 2 } else { 1 }),
                Shape::Listed(pairs) => listed.extend(pairs.iter().flat_map(|[a, b]| [(*a, *b), (*b, *a)])),
                // Every copy is like the first.
                Shape::File(links) => listed.extend(links.members.iter().flat_map(|[a, b]| [(*a, *b), (*b, *a)])),
            }
        }
        // A particle in a listed pair has partners along its chain beside.
        let ends: HashSet<u32> = listed.iter().map(|(end, _)| *end).collect();
        for end in ends {
            let Some((first, [chains, beads, closed])) = groups.range(..=u64::from(end)).next_back() else { continue };
            let place = u64::from(end) - first;
            if place >= chains * beads {
                continue;
            }
            let (start, bead) = (first + place / beads * beads, place % beads);
            let after = (*closed == 1 || bead + 1 < *beads).then(|| (bead + 1) % beads);
            let before = (*closed == 1 || bead > 0).then(|| (bead + beads - 1) % beads);
            listed.extend([after, before].into_iter().flatten().map(|bead| (end, (start + bead) as u32)));
        }
        let mut counts = HashMap::new();
        for (end, _) in &listed {
            *counts.entry(*end).or_insert(0_usize) += 1;
        }
        counts.into_values().fold(most, usize::max)
    }
}

impl<const LENGTH: usize> Shape<LENGTH> {
    fn count(&self) -> u64 {
        match self {
            Self::Chains { chains, starts, .. } => chains.saturating_mul(*starts),
            Self::Strand { beads, .. } => u64::from(*beads) + 1,
            Self::Listed(runs) => runs.len() as u64,
            Self::File(links) => links.count(),
        }
    }

    /// One of the runs.
    fn run(&self, index: u64) -> [u32; LENGTH] {
        match self {
            Self::Chains { first, beads, starts, .. } => {
                let (chain, start) = (index / starts, index % starts);
                std::array::from_fn(|at| (first + chain * beads + (start + at as u64) % beads) as u32)
            }
            Self::Strand { before, first, beads, after, .. } => std::array::from_fn(|at| match index + at as u64 {
                0 => *before,
                place if place > u64::from(*beads) => *after,
                place => first + (place - 1) as u32,
            }),
            Self::Listed(runs) => runs[index as usize],
            Self::File(links) => links.link(index),
        }
    }

    fn alike(&self) -> Alike<'_, LENGTH> {
        match self {
            Self::Chains { species, .. } => Alike::Species(*species),
            Self::Strand { species, end_species, .. } => Alike::Ended(*species, *end_species),
            Self::Listed(runs) => Alike::Listed(runs),
            Self::File(links) => Alike::Listed(&links.members),
        }
    }
}

/// Chains or molecules of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChainGroup {
    /// The species of chains; of molecules all of them, with numbers of particles.
    pub name: String,
    /// Number of chains or molecules.
    pub chains: u32,
    /// Particles in one of them.
    pub beads: u32,
    /// True if they have two ends.
    pub linear: bool,
    /// Steps of a walk along the bonds of one of them.
    pub steps: u32,
    /// These walks.
    pub walks: Walks,
}

/// Walks from particle to particle along the bonds of each chain or molecule of a kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Walks {
    /// Along consecutive numbers from that of the first particle of the first chain.
    Consecutive(u32),
    /// As they are listed, one after the other, with the highest bit at particles to which a walk goes back.
    Listed(Arc<[u32]>),
}

/// All groups of chains, or all kinds of molecules that the bonds of a start make.
pub(crate) fn chain_groups(scene: &Scene, bonds: &Bonds) -> Vec<ChainGroup> {
    let group = |(numbered, chain): (NumberedGroup<'_>, &Chain)| {
        let beads = numbered.beads() as u32;
        ChainGroup {
            name: numbered.group.species.clone(),
            chains: numbered.chains() as u32,
            beads,
            linear: !chain.closed || beads <= 2,
            steps: beads,
            walks: Walks::Consecutive(numbered.first as u32),
        }
    };
    if scene.chained_groups(None).next().is_none() {
        return molecule_groups(scene, bonds);
    }
    let wanted = scene.output.chain_sizes.as_ref().and_then(|asked| asked.species.as_ref()).map(std::slice::from_ref);
    scene.chained_groups(wanted).map(group).collect()
}

/// All kinds of molecules, where a scene measures them: nothing else needs to know them.
fn molecule_groups(scene: &Scene, bonds: &Bonds) -> Vec<ChainGroup> {
    let Some((start, asked)) = scene.start().zip(scene.output.chain_sizes.as_ref()) else { return Vec::new() };
    let species = |particle: u32| start.species_of(particle).unwrap_or(0);
    let wanted = asked.species.as_ref().and_then(|name| SpeciesNames::of(scene).place(name));
    let mut kinds = molecules(bonds.iter().map(|bond| bond.ends), start.particles() as u32, species);
    kinds.retain(|kind| wanted.is_none_or(|wanted| kind.composition.contains_key(&wanted)));
    let mut groups: Vec<ChainGroup> = Vec::with_capacity(kinds.len());
    let mut known: HashMap<String, u32> = HashMap::new();
    for kind in kinds {
        let mut group = ChainGroup::new(scene, &kind);
        // Molecules of the same particles, otherwise joined.
        let number = known.entry(group.name.clone()).or_insert(0);
        *number += 1;
        if *number > 1 {
            group.name = format!("{} ({number})", group.name);
        }
        groups.push(group);
    }
    groups
}

impl ChainGroup {
    fn new(scene: &Scene, molecules: &BondedMolecules) -> Self {
        let species = SpeciesNames::of(scene);
        let part = |(place, count): (&usize, &u32)| {
            let name = species.names().get(*place).copied().unwrap_or_default();
            if *count == 1 { name.to_owned() } else { format!("{count} {name}") }
        };
        Self {
            name: molecules.composition.iter().map(part).collect::<Vec<_>>().join(" + "),
            chains: molecules.count(),
            beads: molecules.beads(),
            linear: molecules.linear,
            steps: molecules.steps,
            walks: Walks::Listed(Arc::clone(&molecules.walks)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chains(first: u64, chains: u64, beads: u64, starts: u64) -> Stretch<2> {
        Stretch { kind: 0, shape: Shape::Chains { first, chains, beads, starts, species: 0 } }
    }

    #[test]
    fn chains_open_and_closed_are_described_without_being_listed() {
        let runs = Runs { stretches: vec![chains(2, 2, 3, 2), chains(8, 1, 3, 3)] };
        let all: Vec<[u32; 2]> = runs.iter().map(|link| link.ends).collect();
        assert_eq!(all, [[2, 3], [3, 4], [5, 6], [6, 7], [8, 9], [9, 10], [10, 8]]);
        assert_eq!(runs.count(), 7);
        // Four thousand million beads take no more than ten.
        let endless = Runs { stretches: vec![chains(0, 400_000_000, 10, 9)] };
        assert_eq!((endless.count(), endless.most_partners(|_| true)), (3_600_000_000, 2));
        assert_eq!(endless.iter().nth(9), Some(Link { ends: [10, 11], kind: 0 }));
    }

    /// The number of partners counted by hand.
    #[test]
    fn partners_are_those_of_all_runs_together() {
        let cases: [(Vec<Stretch<2>>, Vec<[u32; 2]>); 5] = [
            (vec![chains(0, 3, 2, 1)], vec![]),
            (vec![chains(0, 3, 4, 3)], vec![[0, 1], [1, 5], [1, 9], [3, 4]]),
            (vec![chains(0, 2, 4, 4), chains(0, 2, 4, 3)], vec![[0, 2], [6, 1]]),
            (vec![chains(1, 0, 4, 3)], vec![[7, 8]]),
            (vec![], vec![]),
        ];
        for (mut stretches, listed) in cases {
            stretches.push(Stretch { kind: 0, shape: Shape::Listed(listed) });
            let runs = Runs { stretches };
            let mut partners = vec![HashSet::new(); 20];
            for Link { ends: [a, b], .. } in runs.iter() {
                partners[a as usize].insert(b);
                partners[b as usize].insert(a);
            }
            let counted = partners.iter().map(HashSet::len).max().unwrap_or(0);
            assert_eq!(runs.most_partners(|_| true), counted, "{runs:?}");
        }
    }

    #[test]
    fn a_strand_hangs_between_its_ends() {
        let mut runs = Runs::<2>::default();
        runs.add_strand(3, [20, 21], 5, 2, [0, 2]);
        let strand = [[20, 5], [5, 6], [6, 21]].map(|ends| Link { ends, kind: 3 });
        assert_eq!(runs.iter().collect::<Vec<_>>(), strand);
    }
}
