//! What a scene keeps of the file that its particles start from, or of the molecules that they form.

use super::{Change, Scene, number_of_copies};
use crate::state::State;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a scene keeps of the file that its particles start from, in the order of the file.
///
/// Copies of the box follow each other, x first; in each of them the particles are in this order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileStart {
    /// Copies of the box of the file along every axis.
    pub copies: [u32; 3],
    /// The species of each particle of a copy, by their first appearance in the scene.
    pub species: Vec<u8>,
    /// The largest component of the velocities of every species.
    pub fastest: Vec<f64>,
    /// Bonds, type by type.
    pub bonds: Vec<Arc<FileLinks<2>>>,
    /// Angles, type by type.
    pub angles: Vec<Arc<FileLinks<3>>>,
    /// How dense it is around the particles, where there is a pair force.
    pub surroundings: Option<Surroundings>,
    /// How the noise begins; none without a file, and where a run of an earlier version continues, whose noise is that of the scene's seed.
    pub origin: Option<Origin>,
    /// Changes between the steps of the simulation that left the file.
    pub changes: Vec<Change>,
    /// Places and velocities; none where a run continues, whose checkpoint has them.
    pub places: Option<FilePlaces>,
}

/// Number densities around particles at a start that says where they are.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Surroundings {
    /// Densities of all species in the densest places of each.
    pub densest: Vec<Vec<f64>>,
    /// The density of all particles around one, on average.
    pub mean: f64,
}

impl Surroundings {
    /// The largest density of all species together.
    pub(crate) fn largest(&self) -> f64 {
        self.densest.iter().map(|of_all| of_all.iter().sum()).fold(self.mean, f64::max)
    }
}

/// How the noise of a run begins whose particles are from a file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Origin {
    /// With a seed of its own, made of that of the scene and of what was read.
    Anew,
    /// Where that of an earlier run ended, with which it goes on.
    Earlier(EarlierRun),
}

/// What a run has of an earlier one with the same forces, baths and time step: it takes the steps that the other would have taken
/// next, to the last bit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EarlierRun {
    /// Seed of its noise.
    pub seed: u64,
    /// Steps before the first: noise and what depends on time are counted on from there.
    pub steps: u64,
    /// Value of one unit of integer momentum.
    pub momentum_unit: f64,
    /// The largest velocity along an axis that is expected of a particle.
    pub expected_velocity: f64,
}

/// Where the particles of a file are in its box, and how fast.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FilePlaces {
    /// Positions as fractions of the box of the file, in units of 2⁻³².
    pub positions: Vec<[u32; 3]>,
    /// Velocities, where the scene takes them from the file; else empty.
    pub velocities: Vec<[f64; 3]>,
    /// How often each particle has gone round the box; empty where the file does not say or copies leave it no meaning.
    pub images: Vec<[i32; 3]>,
    /// The points that particles are tied to, as fractions of the same box; empty where the file does not say.
    pub tethers: Vec<[u32; 3]>,
    /// The state of a run that goes on, in place of all these.
    pub state: Option<State>,
    /// Fields of shallow water, whose particles are where its groups say.
    pub fields: Option<Arc<MeshFields>>,
    /// Units of mass of the particles of shallow water, where an earlier run has them; else empty.
    pub masses: Vec<u32>,
}

/// Fields that shallow water starts from: values on the nodes of its mesh, with node (k, l) in place k + l·nₓ.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFields {
    /// The smoothed depth h, in mean depths.
    pub depth: Vec<f64>,
    /// The velocity along x and along y; none where the scene says how the water moves.
    pub velocity: Option<[Vec<f64>; 2]>,
}

/// Bonds or angles of one type in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct FileLinks<const LENGTH: usize> {
    /// The name of the type.
    pub name: String,
    /// The particles of one copy.
    pub members: Vec<[u32; LENGTH]>,
    /// In which copy each of them is, from that of the first, going the shortest way; empty where there is one copy.
    pub shifts: Vec<[[i8; 3]; LENGTH]>,
    /// Copies along every axis.
    pub copies: [u32; 3],
    /// Particles of a copy.
    pub particles: u32,
    /// Shortest and longest distance of the first two, by their species.
    pub spans: BTreeMap<(u8, u8), [f64; 2]>,
}

impl<const LENGTH: usize> FileLinks<LENGTH> {
    /// Number of links in all copies.
    pub(crate) fn count(&self) -> u64 {
        self.members.len() as u64 * number_of_copies(self.copies)
    }

    /// The particles of one of them, copy by copy.
    pub(crate) fn link(&self, index: u64) -> [u32; LENGTH] {
        let each = self.members.len().max(1) as u64;
        let (copy, place) = (index / each, (index % each) as usize);
        let members = self.members[place];
        let Some(shifts) = self.shifts.get(place) else { return members };
        let [x, y, _] = self.copies.map(u64::from);
        let cell = [copy % x, copy / x % y, copy / (x * y)];
        std::array::from_fn(|at| {
            let [i, j, k] = std::array::from_fn(|axis| {
                (cell[axis] as i64 + i64::from(shifts[at][axis])).rem_euclid(self.copies[axis].into()) as u64
            });
            ((i + x * (j + y * k)) * u64::from(self.particles) + u64::from(members[at])) as u32
        })
    }
}

/// The part of a start that is text in a checkpoint; the arrays follow it.
#[derive(Serialize, Deserialize)]
struct Description {
    copies: [u32; 3],
    particles: u32,
    fastest: Vec<f64>,
    bonds: Vec<DescribedLinks>,
    angles: Vec<DescribedLinks>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surroundings: Option<Surroundings>,
    #[serde(default)]
    origin: Option<Origin>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    changes: Vec<Change>,
}

#[derive(Serialize, Deserialize)]
struct DescribedLinks {
    name: String,
    count: u64,
    spans: Vec<(u8, u8, f64, f64)>,
}

impl FileStart {
    /// Number of particles in all copies.
    #[must_use]
    pub fn particles(&self) -> u64 {
        (self.species.len() as u64).saturating_mul(number_of_copies(self.copies))
    }

    /// The species of a particle.
    pub(crate) fn species_of(&self, particle: u32) -> Option<usize> {
        self.species.get(particle as usize % self.species.len().max(1)).map(|species| *species as usize)
    }

    /// Whether it is one of a scene, as far as that can be seen: nothing is out of range.
    pub(crate) fn fits(&self, scene: &Scene) -> bool {
        let species = super::SpeciesNames::of(scene).count();
        let particles = self.species.len() as u64;
        let copies = scene.state.as_ref().map_or([1; 3], super::StateFile::copies);
        let is_there = |member: &u32| u64::from(*member) < particles;
        scene.has_start()
            && copies == self.copies
            && self.fastest.len() == species
            && self.surroundings.as_ref().is_none_or(|around| {
                let is_one = |density: &f64| density.is_finite() && *density >= 0.0;
                around.densest.len() == species
                    && around.densest.iter().all(|of_all| of_all.len() == species && of_all.iter().all(is_one))
                    && is_one(&around.mean)
            })
            && self.species.iter().all(|index| usize::from(*index) < species)
            && self.bonds.iter().flat_map(|links| links.members.iter().flatten()).all(is_there)
            && self.angles.iter().flat_map(|links| links.members.iter().flatten()).all(is_there)
    }

    /// What a run needs of it to continue, as bytes: all but places.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        fn described<const LENGTH: usize>(all: &[Arc<FileLinks<LENGTH>>]) -> Vec<DescribedLinks> {
            let one = |links: &Arc<FileLinks<LENGTH>>| DescribedLinks {
                name: links.name.clone(),
                count: links.members.len() as u64,
                spans: links.spans.iter().map(|((a, b), [least, most])| (*a, *b, *least, *most)).collect(),
            };
            all.iter().map(one).collect()
        }
        fn arrays<const LENGTH: usize>(all: &[Arc<FileLinks<LENGTH>>], bytes: &mut Vec<u8>) {
            for links in all {
                bytes.extend(links.members.iter().flatten().flat_map(|member| member.to_le_bytes()));
                bytes.extend(links.shifts.iter().flatten().flatten().map(|shift| shift.cast_unsigned()));
            }
        }
        let description = Description {
            copies: self.copies,
            particles: self.species.len() as u32,
            fastest: self.fastest.clone(),
            bonds: described(&self.bonds),
            angles: described(&self.angles),
            surroundings: self.surroundings.clone(),
            origin: self.origin,
            changes: self.changes.clone(),
        };
        // Numbers and text, which can always be written.
        let text = serde_json::to_vec(&description).unwrap_or_default();
        let mut bytes = (text.len() as u64).to_le_bytes().to_vec();
        bytes.extend(text);
        bytes.extend(&self.species);
        arrays(&self.bonds, &mut bytes);
        arrays(&self.angles, &mut bytes);
        bytes
    }

    /// What [`to_bytes`](Self::to_bytes) has written; none of anything else.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Option<Self> {
        fn take<'a>(bytes: &mut &'a [u8], count: u64) -> Option<&'a [u8]> {
            let (taken, rest) = bytes.split_at_checked(usize::try_from(count).ok()?)?;
            *bytes = rest;
            Some(taken)
        }
        fn links<const LENGTH: usize>(
            bytes: &mut &[u8],
            all: Vec<DescribedLinks>,
            copies: [u32; 3],
            particles: u32,
        ) -> Option<Vec<Arc<FileLinks<LENGTH>>>> {
            let one = |described: DescribedLinks| {
                let words = take(bytes, described.count.checked_mul(4 * LENGTH as u64)?)?;
                let mut words = words.chunks_exact(4).map(|word| word.try_into().map_or(0, u32::from_le_bytes));
                let members =
                    (0..described.count).map(|_| std::array::from_fn(|_| words.next().unwrap_or(0))).collect();
                let shifted = if copies == [1; 3] { 0 } else { described.count };
                let shifts = take(bytes, shifted.checked_mul(3 * LENGTH as u64)?)?;
                let mut shifts = shifts.iter().map(|shift| shift.cast_signed());
                let mut next = || std::array::from_fn(|_| std::array::from_fn(|_| shifts.next().unwrap_or(0)));
                let shifts = (0..shifted).map(|_| next()).collect();
                let spans = described.spans.into_iter().map(|(a, b, least, most)| ((a, b), [least, most])).collect();
                Some(Arc::new(FileLinks { name: described.name, members, shifts, copies, particles, spans }))
            };
            all.into_iter().map(one).collect()
        }
        let mut bytes = bytes;
        let length = u64::from_le_bytes(take(&mut bytes, 8)?.try_into().ok()?);
        let Description { copies, particles, fastest, bonds, angles, surroundings, origin, changes } =
            serde_json::from_slice(take(&mut bytes, length)?).ok()?;
        let species = take(&mut bytes, particles.into())?.to_vec();
        let bonds = links(&mut bytes, bonds, copies, particles)?;
        let angles = links(&mut bytes, angles, copies, particles)?;
        (bytes.is_empty() && !copies.contains(&0)).then_some(Self {
            copies,
            species,
            fastest,
            bonds,
            angles,
            surroundings,
            origin,
            changes,
            places: None,
        })
    }
}

/// The start of a scene, once its file has been read. Scenes are compared without it: the checksum of what was read is in the scene.
#[derive(Debug, Clone, Default)]
pub struct KeptStart(Option<Arc<FileStart>>);

impl PartialEq for KeptStart {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl KeptStart {
    pub(crate) fn of(start: Arc<FileStart>) -> Self {
        Self(Some(start))
    }

    pub(crate) fn get(&self) -> Option<&Arc<FileStart>> {
        self.0.as_ref()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::document::Rounding;

    fn links<const LENGTH: usize>(
        members: Vec<[u32; LENGTH]>,
        shifts: Vec<[[i8; 3]; LENGTH]>,
        copies: [u32; 3],
    ) -> Arc<FileLinks<LENGTH>> {
        let spans = BTreeMap::from([((0, 1), [0.1, 0.7])]);
        Arc::new(FileLinks { name: "a bond".to_owned(), members, shifts, copies, particles: 5, spans })
    }

    #[test]
    fn links_go_on_in_the_next_copy() {
        // Three copies in a row along x, two along y; the bond leaves the box upwards along x.
        let bonds = links(vec![[1, 4]], vec![[[0; 3], [1, 0, 0]]], [3, 2, 1]);
        assert_eq!(bonds.count(), 6);
        let all: Vec<[u32; 2]> = (0..6).map(|index| bonds.link(index)).collect();
        assert_eq!(all, [[1, 9], [6, 14], [11, 4], [16, 24], [21, 29], [26, 19]]);
        // Without copies it stays where it is.
        assert_eq!(links(vec![[1, 4]], Vec::new(), [1; 3]).link(0), [1, 4]);
    }

    #[test]
    fn bytes_give_it_back_and_no_part_of_them_does() {
        for copies in [[1, 1, 1], [2, 1, 3]] {
            let shifts = |count: usize| if copies == [1; 3] { 0 } else { count };
            let start = FileStart {
                copies,
                species: vec![0, 1, 1, 0, 2],
                fastest: vec![0.1, 1.0 / 3.0, 0.0],
                bonds: vec![
                    links(vec![[0, 1], [3, 4]], vec![[[0, 0, 0], [0, -1, 1]]; shifts(2)], copies),
                    links(Vec::new(), Vec::new(), copies),
                ],
                angles: vec![links(vec![[0, 1, 4]], vec![[[0; 3], [1; 3], [-1; 3]]; shifts(1)], copies)],
                surroundings: (copies == [1; 3])
                    .then(|| Surroundings { densest: vec![vec![0.1; 3]; 3], mean: 1.0 / 3.0 }),
                origin: Some(Origin::Earlier(EarlierRun {
                    seed: u64::MAX,
                    steps: 7,
                    momentum_unit: 1e-8 / 3.0,
                    expected_velocity: 0.1,
                })),
                changes: vec![Change {
                    step: 3,
                    key: "temperature".to_owned(),
                    value: 0.5.into(),
                    rounding: Rounding { largest: 1e-8 / 3.0, momentum: [0.0; 3] },
                }],
                places: None,
            };
            let bytes = start.to_bytes();
            assert_eq!(FileStart::from_bytes(&bytes).unwrap(), start);
            for length in 0..bytes.len() {
                assert_eq!(FileStart::from_bytes(&bytes[..length]), None, "{length}");
            }
        }
    }
}
