//! Molecules: particles that bonds join.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// Molecules of one kind: with as many particles of every species, and as many bonds at each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BondedMolecules {
    /// Species and numbers of their particles, by the places of the species.
    pub composition: BTreeMap<usize, u32>,
    /// True if they are chains with two ends, at which walks begin and end.
    pub linear: bool,
    /// Steps of a walk along the bonds of a molecule, from particle to particle, to all of them.
    pub steps: u32,
    /// The walks, molecule by molecule: numbers of particles, with [`Self::REVISITED`] where a walk goes back over
    /// them.
    pub walks: Arc<[u32]>,
}

impl BondedMolecules {
    /// The bit that marks a particle which a walk comes to again.
    pub const REVISITED: u32 = 1 << 31;

    /// Number of molecules.
    pub(crate) fn count(&self) -> u32 {
        (self.walks.len() / self.steps.max(1) as usize) as u32
    }

    /// Number of particles in a molecule.
    pub(crate) fn beads(&self) -> u32 {
        self.composition.values().sum()
    }
}

/// The molecules that bonds make of so many particles, kind by kind in the order of their first particles. Particles
/// without bonds are none.
pub(super) fn molecules(
    bonds: impl Iterator<Item = [u32; 2]>,
    particles: u32,
    species: impl Fn(u32) -> usize,
) -> Vec<BondedMolecules> {
    let neighbours = Neighbours::new(bonds, particles);
    let mut is_known = vec![false; particles as usize];
    let mut kinds: Vec<(Kind, Vec<Vec<u32>>)> = Vec::new();
    let mut places: BTreeMap<Kind, usize> = BTreeMap::new();
    for particle in 0..particles {
        if is_known[particle as usize] || neighbours.of(particle).is_empty() {
            continue;
        }
        let members = neighbours.joined(particle, &mut is_known);
        let kind = Kind::new(&neighbours, &members, &species);
        let end = members.iter().filter(|member| neighbours.of(**member).len() == 1).min();
        let walk = neighbours.walk(end.copied().unwrap_or(particle));
        let place = *places.entry(kind.clone()).or_insert_with(|| {
            kinds.push((kind, Vec::new()));
            kinds.len() - 1
        });
        kinds[place].1.push(walk);
    }
    kinds.into_iter().map(|(kind, walks)| kind.molecules(&walks)).collect()
}

/// The common properties of molecules of a kind: numbers of particles by species and number of bonds.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    particles: BTreeMap<(usize, usize), u32>,
}

impl Kind {
    fn new(neighbours: &Neighbours, members: &[u32], species: impl Fn(u32) -> usize) -> Self {
        let mut particles = BTreeMap::new();
        for member in members {
            *particles.entry((species(*member), neighbours.of(*member).len())).or_insert(0) += 1;
        }
        Self { particles }
    }

    /// A path has two ends, and no particle with more than two bonds; what is joined has no other such part.
    fn is_linear(&self) -> bool {
        let with = |bonds: usize| -> u32 {
            self.particles.iter().filter(|((_, own), _)| *own == bonds).map(|(_, count)| count).sum()
        };
        with(1) == 2 && self.particles.keys().all(|(_, bonds)| *bonds <= 2)
    }

    fn molecules(self, walks: &[Vec<u32>]) -> BondedMolecules {
        let steps = walks.iter().map(Vec::len).max().unwrap_or(0);
        let mut all = Vec::with_capacity(steps * walks.len());
        for walk in walks {
            all.extend(walk);
            // The last particle again: walks of a kind may go back more or less often.
            let last = walk.last().map_or(0, |last| last | BondedMolecules::REVISITED);
            all.extend(std::iter::repeat_n(last, steps - walk.len()));
        }
        let linear = self.is_linear();
        let mut composition = BTreeMap::new();
        for ((species, _), count) in self.particles {
            *composition.entry(species).or_insert(0) += count;
        }
        BondedMolecules { composition, linear, steps: steps as u32, walks: all.into() }
    }
}

/// The particles that each particle has bonds to, in order.
pub(crate) struct Neighbours {
    starts: Vec<usize>,
    all: Vec<u32>,
}

impl Neighbours {
    pub(crate) fn new(bonds: impl Iterator<Item = [u32; 2]>, particles: u32) -> Self {
        let mut bonds: Vec<[u32; 2]> = bonds.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        bonds.retain(|[a, b]| a != b);
        bonds.sort_unstable();
        bonds.dedup();
        let starts = (0..=particles).map(|particle| bonds.partition_point(|[a, _]| *a < particle)).collect();
        Self { starts, all: bonds.into_iter().map(|[_, b]| b).collect() }
    }

    fn of(&self, particle: u32) -> &[u32] {
        let particle = particle as usize;
        &self.all[self.starts[particle]..self.starts[particle + 1]]
    }

    /// All particles that bonds join with one.
    pub(crate) fn joined(&self, particle: u32, is_known: &mut [bool]) -> Vec<u32> {
        let mut members = vec![particle];
        is_known[particle as usize] = true;
        let mut next = 0;
        while let Some(member) = members.get(next).copied() {
            next += 1;
            for other in self.of(member) {
                if !std::mem::replace(&mut is_known[*other as usize], true) {
                    members.push(*other);
                }
            }
        }
        members
    }

    /// A walk to all particles that are joined with one, which goes back where a branch ends.
    fn walk(&self, from: u32) -> Vec<u32> {
        let mut walk = vec![from];
        let mut visited = HashSet::from([from]);
        // The way from the first particle to the last, and the place of the next bond at each.
        let mut way = vec![(from, 0)];
        let mut steps = 1;
        while let Some((particle, next)) = way.last_mut() {
            let Some(other) = self.of(*particle).get(*next).copied() else {
                way.pop();
                walk.extend(way.last().map(|(before, _)| before | BondedMolecules::REVISITED));
                continue;
            };
            *next += 1;
            if visited.insert(other) {
                walk.push(other);
                steps = walk.len();
                way.push((other, 0));
            }
        }
        walk.truncate(steps);
        walk
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BACK: u32 = BondedMolecules::REVISITED;

    #[test]
    fn bonds_join_molecules_of_kinds() {
        // Two chains in either order, a particle by itself, a star whose centre is 7, a ring, and a star with a longer
        // arm.
        let species = [0, 1, 1, 1, 1, 0, 2, 0, 0, 0, 0, 0, 0, 0];
        let bonds = [[0, 1], [1, 2], [3, 4], [4, 5], [5, 4], [7, 8], [7, 9], [10, 7], [11, 12], [12, 13], [13, 11]];
        let molecules = molecules(bonds.into_iter(), 14, |particle| species[particle as usize]);
        assert_eq!(molecules.len(), 3);
        let [chains, stars, rings] = [&molecules[0], &molecules[1], &molecules[2]];
        assert!(chains.linear && !stars.linear && !rings.linear);
        assert_eq!((chains.count(), chains.beads(), &chains.walks[..]), (2, 3, &[0, 1, 2, 3, 4, 5][..]));
        assert_eq!(chains.composition, BTreeMap::from([(0, 1), (1, 2)]));
        assert_eq!(&stars.walks[..], [8, 7, 9, 7 | BACK, 10]);
        assert_eq!(&rings.walks[..], [11, 12, 13]);
    }

    #[test]
    fn walks_of_a_kind_have_as_many_steps() {
        // The same tree twice: the longer arm comes last, and before another.
        let bonds = [[0, 1], [1, 2], [1, 3], [3, 4], [5, 6], [6, 7], [7, 8], [6, 9]];
        let found = molecules(bonds.into_iter(), 10, |_| 0);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].steps, found[0].count(), found[0].beads()), (7, 2, 5));
        let [first, second] = [[0, 1, 2, 1 | BACK, 3, 4, 4 | BACK], [5, 6, 7, 8, 7 | BACK, 6 | BACK, 9]];
        assert_eq!(&found[0].walks[..], [first, second].concat());
        assert!(molecules(std::iter::empty(), 3, |_| 0).is_empty());
    }
}
