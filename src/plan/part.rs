//! The box divided among several ranks: who advances a particle, and who else has to know it.
//!
//! A position alone decides. Domains are bounded by integers, so that every adapter finds the same; a rank stores its own particles
//! and copies of those within a halo around its domain.

use super::PARTICLE_WORDS;
use crate::shaders::Array;
use crate::state::Units;
use std::ops::Range;

/// Places of particles that have gone are closed when they are more than this part of those that are taken.
pub(crate) const FREE_SHARE: u64 = 8;

/// Particles of a message between ranks, which is therefore some 32 MB long.
const PORTION: u64 = 1 << 20;

/// Parts of the box on each axis, all alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Division {
    /// Number of parts on each axis.
    pub parts: [u32; 3],
}

/// A part of the periodic box, in fractions of 2⁻³²; a width of zero is the whole axis. Lies on the device as
/// `shaders/ranks/domain.wgsl` declares it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Domain {
    low: [u32; 4],
    width: [u32; 4],
}

/// Rows of cells of a mesh, one above the other along y, of which each rank has whole ones.
///
/// What cells do with their particles is rounded once a cell: a cell that two ranks shared would be rounded twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rows {
    /// Number of rows.
    pub count: u32,
    /// Whether cells are centred on the nodes of the mesh, rather than between them.
    pub centred: bool,
}

/// Bounds have to be beyond the cutoff as single precision finds it.
const MARGIN: f64 = 1.0 + 1e-5;

/// A distance along an axis of a length, rounded up, in fractions of 2⁻³².
fn fraction(distance: f64, length: f64) -> u64 {
    (distance * MARGIN / length * 2_f64.powi(32)).ceil() as u64 + 1
}

/// Neighbouring cells of a grid; after the last cell of an axis comes the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cells {
    /// The first of them on each axis.
    pub first: [u32; 3],
    /// How many there are on each axis.
    pub count: [u32; 3],
}

impl Cells {
    /// Their part of a grid of so many cells.
    pub(crate) fn share(&self, of: [u32; 3]) -> f64 {
        (0..3).map(|axis| f64::from(self.count[axis]) / f64::from(of[axis])).product()
    }
}

/// Kernels find the cell of a position in single precision, and not of its last bits: fractions that a cell may begin earlier or later.
const ROUNDING: i64 = 1024;

impl Division {
    /// Number of ranks.
    #[must_use]
    pub fn ranks(&self) -> u32 {
        self.parts.iter().product()
    }

    /// The place of a rank on each axis.
    fn place(&self, rank: u32) -> [u32; 3] {
        let [x, y, _] = self.parts;
        [rank % x, rank / x % y, rank / (x * y)]
    }

    /// The domain of a rank.
    ///
    /// ```
    /// use mesoscope::plan::Division;
    ///
    /// let division = Division { parts: [1, 1, 3] };
    /// let positions = [[7, 7, 0], [7, 7, u32::MAX / 3], [7, 7, u32::MAX / 3 + 1], [7, 7, u32::MAX]];
    /// let owners = positions.map(|position| (0..3).find(|&rank| division.domain(rank).contains(position)));
    /// assert_eq!(owners, [Some(0), Some(0), Some(1), Some(2)]);
    /// ```
    #[must_use]
    pub fn domain(&self, rank: u32) -> Domain {
        let place = self.place(rank);
        let mut domain = Domain { low: [0; 4], width: [0; 4] };
        for axis in (0..3).filter(|&axis| self.parts[axis] > 1) {
            // Rounded up: the first fraction that is not below the bound.
            let bound = |place: u32| (u64::from(place) << 32).div_ceil(u64::from(self.parts[axis]));
            let (low, high) = (bound(place[axis]), bound(place[axis] + 1));
            (domain.low[axis], domain.width[axis]) = (low as u32, (high - low) as u32);
        }
        domain
    }

    /// The rows that a rank has.
    pub(crate) fn rows(&self, rank: u32, rows: Rows) -> Range<u32> {
        let bound = |place: u32| (u64::from(place) * u64::from(rows.count)).div_ceil(u64::from(self.parts[1])) as u32;
        let place = self.place(rank)[1];
        bound(place)..bound(place + 1)
    }

    /// The domain of a rank that has whole rows.
    ///
    /// ```
    /// use mesoscope::plan::{Division, Rows};
    ///
    /// // Five rows for two ranks: three and two.
    /// let (division, rows) = (Division { parts: [1, 2, 1] }, Rows { count: 5, centred: false });
    /// let owner = |y: u32| (0..2).find(|&rank| division.domain_of_rows(rank, rows).contains([7, y, 0]));
    /// let bound = (3_u64 << 32).div_ceil(5) as u32;
    /// assert_eq!([0, bound - 1, bound, u32::MAX].map(owner), [Some(0), Some(0), Some(1), Some(1)]);
    /// // The lowest row of cells that are centred on nodes begins below the end of the box.
    /// let rows = Rows { centred: true, ..rows };
    /// let owner = |y: u32| (0..2).find(|&rank| division.domain_of_rows(rank, rows).contains([7, y, 0]));
    /// assert_eq!(owner(u32::MAX), Some(0));
    /// ```
    #[must_use]
    pub fn domain_of_rows(&self, rank: u32, rows: Rows) -> Domain {
        let mut domain = Domain { low: [0; 4], width: [0; 4] };
        if self.parts[1] > 1 {
            // The first fraction of a row, as `place_along` in shaders/mesh/mesh.wgsl finds rows.
            let shift = if rows.centred { 1 << 31 } else { 0 };
            let count = i64::from(rows.count);
            let first = |row: u32| ((i64::from(row) << 32) - shift + count - 1).div_euclid(count) as u32;
            let Range { start, end } = self.rows(rank, rows);
            domain.low[1] = first(start);
            domain.width[1] = first(end).wrapping_sub(first(start));
        }
        domain
    }

    /// All ranks but one.
    fn others(&self, rank: u32) -> Vec<u32> {
        (0..self.ranks()).filter(|other| *other != rank).collect()
    }

    /// The ranks around a rank with anything nearer to its part than a distance, each once and without it.
    pub(crate) fn peers(&self, rank: u32, units: &Units, distance: f64) -> Vec<u32> {
        let place = self.place(rank);
        let along = |axis: usize| {
            let (parts, here) = (self.parts[axis], place[axis]);
            let width = units.lengths[axis] / f64::from(parts);
            // The part next to it begins where it ends.
            let off = ((distance * MARGIN / width).floor().min(f64::from(parts)) as u32 + 1).min(parts / 2);
            (parts - off..=parts + off).map(move |part| (here + part) % parts)
        };
        let mut peers: Vec<u32> = Vec::new();
        for z in along(2) {
            for y in along(1) {
                peers.extend(along(0).map(|x| x + self.parts[0] * (y + self.parts[1] * z)));
            }
        }
        peers.sort_unstable();
        peers.dedup();
        peers.retain(|peer| *peer != rank);
        peers
    }

    /// Whether a part, with a halo of this width around it, is smaller than the box, and so wide that a particle that leaves it within
    /// a step is no concern of the part after the next.
    #[must_use]
    #[cfg(test)]
    fn suits(&self, units: &Units, halo: f64, reach: f64) -> bool {
        (0..3).all(|axis| self.parts[axis] <= Self::most_parts(units, halo, reach, axis))
    }

    /// The most parts of an axis that suit.
    pub(crate) fn most_parts(units: &Units, halo: f64, reach: f64, axis: usize) -> u32 {
        if axis >= units.dimension {
            return 1;
        }
        let (length, halo) = (units.lengths[axis], halo * MARGIN);
        let fits = |parts: u32| {
            let width = length / f64::from(parts);
            width > halo + reach * MARGIN && width + 2.0 * halo < length
        };
        let most = (length / (halo + reach)).clamp(1.0, 1024.0) as u32;
        (2..=most).rev().find(|parts| fits(*parts)).unwrap_or(1)
    }
}

impl Domain {
    /// The same with what is nearer than a distance.
    pub(crate) fn with_halo(mut self, units: &Units, distance: f64) -> Self {
        for axis in 0..3 {
            if self.width[axis] == 0 {
                continue;
            }
            let halo = fraction(distance, units.lengths[axis]);
            let width = u64::from(self.width[axis]) + 2 * halo;
            self.low[axis] = self.low[axis].wrapping_sub(halo as u32);
            self.width[axis] = u32::try_from(width).unwrap_or(0);
        }
        self
    }

    /// The same without what is nearer than a distance to its faces, if anything is left. It must not go round the box.
    pub(crate) fn without_edge(mut self, units: &Units, distance: f64) -> Option<Self> {
        for axis in 0..3 {
            if self.width[axis] == 0 {
                continue;
            }
            let edge = fraction(distance, units.lengths[axis]);
            let left = u64::from(self.width[axis]).checked_sub(2 * edge).filter(|left| *left > 0)?;
            (self.low[axis], self.width[axis]) = (self.low[axis].wrapping_add(edge as u32), left as u32);
        }
        Some(self)
    }

    /// The cells of a grid that lie in it whole, if there are any. It must not go round the box.
    ///
    /// ```
    /// use mesoscope::plan::Division;
    ///
    /// // The upper half of seven layers. A cell that ends where it does may be taken for more by rounding.
    /// let upper = Division { parts: [1, 1, 2] }.domain(1);
    /// let cells = upper.cells_within([3, 3, 7]).map(|cells| (cells.first, cells.count));
    /// assert_eq!(cells, Some(([0, 0, 4], [3, 3, 2])));
    /// // And, from the fourth on, all that it may touch: the last of them is the first of the box.
    /// let cells = upper.cells_around([3, 3, 7]);
    /// assert_eq!((cells.first, cells.count), ([0, 0, 3], [3, 3, 5]));
    /// ```
    #[must_use]
    pub fn cells_within(&self, cells: [u32; 3]) -> Option<Cells> {
        let mut within = Cells { first: [0; 3], count: cells };
        for axis in (0..3).filter(|&axis| self.width[axis] > 0) {
            let (low, count) = (i64::from(self.low[axis]), i64::from(cells[axis]));
            let first = ((low + ROUNDING) * count + (1 << 32) - 1) >> 32;
            let end = ((low + i64::from(self.width[axis]) - ROUNDING) * count) >> 32;
            let inside = u32::try_from(end - first).ok().filter(|inside| *inside > 0)?;
            (within.first[axis], within.count[axis]) = (first as u32, inside);
        }
        Some(within)
    }

    /// The cells of a grid that hold anything of it.
    #[must_use]
    pub fn cells_around(&self, cells: [u32; 3]) -> Cells {
        let mut around = Cells { first: [0; 3], count: cells };
        for axis in (0..3).filter(|&axis| self.width[axis] > 0) {
            let (low, count) = (i64::from(self.low[axis]), i64::from(cells[axis]));
            let first = ((low - ROUNDING) * count) >> 32;
            let last = ((low + i64::from(self.width[axis]) + ROUNDING) * count) >> 32;
            if last - first + 1 < count {
                around.first[axis] = first.rem_euclid(count) as u32;
                around.count[axis] = (last - first + 1) as u32;
            }
        }
        around
    }

    /// Whether it is the whole box.
    pub(crate) fn is_whole(&self) -> bool {
        self.width == [0; 4]
    }

    /// Whether a position lies in it.
    #[must_use]
    pub fn contains(&self, position: [u32; 3]) -> bool {
        (0..3).all(|axis| {
            let width = self.width[axis];
            width == 0 || position[axis].wrapping_sub(self.low[axis]) < width
        })
    }

    /// Its part of the volume of the box.
    pub(crate) fn share(&self) -> f64 {
        let along = |width: u32| if width == 0 { 1.0 } else { f64::from(width) / 2_f64.powi(32) };
        self.width[..3].iter().map(|width| along(*width)).product()
    }
}

/// The part of a run that one of several ranks has, before it is planned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// How the box is divided.
    pub division: Division,
    /// The rank.
    pub rank: u32,
}

/// What the plan of one of several ranks has beside that of a single one.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPart {
    /// The rank and the division.
    pub part: Part,
    /// Its own domain, the same with its halo, and those of its peers with their halos; where there are bonds, then the domain within
    /// which all of their ends have to be known.
    pub domains: Vec<Domain>,
    /// The ranks that it exchanges particles with, in the order of their domains.
    pub peers: Vec<u32>,
    /// Width of the halo.
    pub halo: f64,
    /// Width that it has for all but bonds, which may reach as far as they like: a part has to be wider.
    pub close: f64,
    /// What is known besides at steps at which something looks further.
    pub wider: Option<Wider>,
    /// Particles that it can store.
    pub slots: u64,
    /// Particles that it can send to a peer in a step.
    pub room: u64,
    /// Particles of all ranks in a message that passes on a state: so many numbers after each other.
    pub portion: u64,
    /// When particles are exchanged.
    pub passages: Vec<Passage>,
    /// The part of a step's arithmetic that the device does while they are under way: an estimate.
    pub overlapped: f64,
    /// How a particle lies in its array.
    pub particle: ParticleWords,
    /// Particles that are shared out; those after them all ranks have.
    pub shared: u64,
    /// Arrays that all ranks have whole, and alike.
    pub whole: Vec<Array>,
    /// The one of these that holds the particles after the shared ones, if there are any.
    pub everywhere: Option<Array>,
    /// What is added over all ranks within a step.
    pub sums: Vec<SharedSum>,
}

/// What ranks know of each other at some steps only: where samples of pairs look further than forces reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Wider {
    /// As [`PlannedPart::domains`], with a wider halo.
    pub domains: Vec<Domain>,
    /// The samplers that need it, as indices into [`super::Plan::samplers`].
    pub samplers: Vec<usize>,
}

/// When particles pass from rank to rank: kernels, as indices into [`super::Plan::kernels`].
///
/// What is between the two the device computes while particles are under way. It neither reads nor writes any of those
/// that are sent or arrive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passage {
    /// The kernel after which they are sent.
    pub after: usize,
    /// The kernel after which those of others are stored; the same if nothing is computed meanwhile.
    pub until: usize,
}

/// How a particle that passes from rank to rank lies in its array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParticleWords {
    /// Words of a particle.
    pub count: usize,
    /// Coordinates, in the first words.
    pub axes: usize,
    /// The word that holds its number.
    pub number: usize,
}

impl ParticleWords {
    /// The position of a particle.
    pub(crate) fn position(&self, particle: &[u32]) -> [u32; 3] {
        std::array::from_fn(|axis| if axis < self.axes { particle[axis] } else { 0 })
    }
}

/// An array of integers that all ranks add to within a step, and then have whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SharedSum {
    /// The array, of signed words.
    pub array: Array,
    /// The fate of sums that a word does not hold.
    pub beyond: Beyond,
    /// The kernel after which it is summed, as an index into [`super::Plan::kernels`].
    pub after: usize,
    /// Words of the array.
    pub length: u64,
    /// Where each rank adds, in order of the ranks: everywhere else it has zeros.
    pub stretches: Vec<Stretch>,
}

/// The fate of a sum beyond the range of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// The least integer stands for it, on one rank or in all.
    Marked,
    /// Its lowest 32 bits, those of parts of it too: the sum of all is in range, though its parts may not be.
    Wrapped,
}

/// Words of an array that goes on at its beginning where it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// The first word.
    pub first: u64,
    /// Number of words.
    pub count: u64,
}

impl SharedSum {
    /// A sum of an array to which every rank adds anywhere.
    pub(crate) fn everywhere(array: Array, beyond: Beyond, length: u64, after: usize, division: &Division) -> Self {
        let all = Stretch { first: 0, count: length };
        Self { array, beyond, after, length, stretches: vec![all; division.ranks() as usize] }
    }

    /// A sum with a word of another rank.
    pub(crate) fn with(&self, sum: i64, word: i32) -> i64 {
        match self.beyond {
            Beyond::Marked if word == i32::MIN => i64::MIN,
            Beyond::Marked | Beyond::Wrapped => sum.saturating_add(word.into()),
        }
    }

    /// The word of a sum.
    pub(crate) fn word(&self, sum: i64) -> i32 {
        match self.beyond {
            Beyond::Marked => i32::try_from(sum).unwrap_or(i32::MIN),
            Beyond::Wrapped => sum as i32,
        }
    }

    /// The parts of a stretch in the array, each from where on and how many words: one, or two of a stretch that goes past the end.
    pub(crate) fn pieces(&self, stretch: Stretch) -> [Stretch; 2] {
        let before_end = stretch.count.min(self.length - stretch.first);
        [Stretch { count: before_end, ..stretch }, Stretch { first: 0, count: stretch.count - before_end }]
    }
}

impl PlannedPart {
    /// Bytes of what is summed that it sends in a step.
    pub(crate) fn summed_bytes(&self) -> u64 {
        let own = |sum: &SharedSum| sum.stretches.get(self.part.rank as usize).map_or(0, |stretch| stretch.count);
        4 * self.sums.iter().map(own).sum::<u64>() * self.others().len() as u64
    }

    /// The numbers of the particles of each message that passes on a state.
    pub(crate) fn portions(&self) -> impl Iterator<Item = Range<u64>> {
        let (all, portion) = (self.shared, self.portion.max(1));
        (0..all.div_ceil(portion).max(1)).map(move |place| place * portion..((place + 1) * portion).min(all))
    }

    /// Whether it knows particles of others, at some steps at least.
    pub(crate) fn has_halo(&self) -> bool {
        self.halo > 0.0 || self.wider.is_some()
    }

    /// All other ranks.
    pub(crate) fn others(&self) -> Vec<u32> {
        self.part.division.others(self.part.rank)
    }
}

/// How many of a number of particles, all over the box, are expected in a share of it: a fifth more than on average, and some; all of
/// them at most. `growth` doublings more are expected in one place.
fn expected(share: f64, particles: u64, growth: u32) -> u64 {
    let some = (1.2 * share * particles as f64) as u64 + 1024;
    some.saturating_mul(1 << growth.min(32)).min(particles)
}

/// How far around a domain particles have to be known for those within it to be advanced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Halo {
    /// For pairs, and whatever else ends within the cutoff.
    pub close: f64,
    /// For everything.
    pub width: f64,
    /// As far around the domain as bonds have to be complete, if there are any.
    pub bonded: Option<f64>,
    /// For samples of pairs, at the steps at which they are taken.
    pub sampled: f64,
}

impl Part {
    /// Plans it for a number of particles, all over the box, none of which goes further in a step than `reach`; `growth` doublings more are
    /// expected in one place.
    pub(crate) fn plan(self, units: &Units, halo: Halo, reach: f64, particles: u64, growth: u32) -> PlannedPart {
        let Self { division, rank } = self;
        let Halo { close, width: halo, bonded, sampled } = halo;
        let own = division.domain(rank);
        let widest = halo.max(sampled);
        let peers = division.peers(rank, units, widest + reach);
        let of_bonds = bonded.map(|bonded| own.with_halo(units, bonded));
        let domains = |halo: f64| -> Vec<Domain> {
            let needed = std::iter::once(&rank).chain(&peers).map(|rank| division.domain(*rank).with_halo(units, halo));
            std::iter::once(own).chain(needed).chain(of_bonds).collect()
        };
        let wider = (sampled > halo).then(|| Wider { domains: domains(sampled), samplers: Vec::new() });
        let domains = domains(halo);
        let expected = |share: f64| expected(share, particles, growth);
        let needed = own.with_halo(units, widest);
        let ghosts = needed.share() - own.share();
        // Those of this step, and what arrives for the next before the copies are forgotten.
        let slots = expected(needed.share()) + expected(ghosts);
        // To one of its peers it sends no more than lies in the halo of that, or all that it has if the peer sees its whole domain.
        let room = expected(ghosts.min(own.share()));
        PlannedPart {
            part: self,
            domains,
            peers,
            halo,
            close,
            wider,
            slots,
            room,
            portion: PORTION,
            passages: Vec::new(),
            overlapped: 0.0,
            particle: ParticleWords { count: PARTICLE_WORDS as usize, axes: 3, number: 3 },
            shared: particles,
            whole: Vec::new(),
            everywhere: None,
            sums: Vec::new(),
        }
    }

    /// The same of a rank that has whole rows of cells, and knows of no particles beyond them; a particle may go to any rank in a step.
    pub(crate) fn plan_of_rows(self, rows: Rows, particle: ParticleWords, particles: u64, growth: u32) -> PlannedPart {
        let Self { division, rank } = self;
        let domain = |rank: u32| division.domain_of_rows(rank, rows);
        let (own, peers) = (domain(rank), division.others(rank));
        let expected = |share: f64| expected(share, particles, growth);
        // A quarter of what it has.
        let room = expected(0.25 * own.share());
        PlannedPart {
            part: self,
            domains: [own, own].into_iter().chain(peers.iter().map(|peer| domain(*peer))).collect(),
            peers,
            halo: 0.0,
            close: 0.0,
            wider: None,
            // Its own, as many free places as are left before they are closed, and what arrives in a step.
            slots: expected(own.share()) + expected(own.share()) / FREE_SHARE + room,
            room,
            portion: PORTION,
            passages: Vec::new(),
            overlapped: 0.0,
            particle,
            shared: particles,
            whole: Vec::new(),
            everywhere: None,
            sums: Vec::new(),
        }
    }

    /// Where this rank and the others add to the nodes of a mesh that has so many columns: on the nodes of their rows of cells, so many
    /// rows before these, and so many after.
    pub(crate) fn stretches(self, rows: Rows, columns: u32, [before, after]: [u32; 2]) -> Vec<Stretch> {
        let of_rank = |rank: u32| {
            let Range { start, end } = self.division.rows(rank, rows);
            let first = u64::from((start + rows.count - before % rows.count) % rows.count);
            let count = u64::from((end - start + before + after).min(rows.count));
            Stretch { first: first * u64::from(columns), count: count * u64::from(columns) }
        };
        (0..self.division.ranks()).map(of_rank).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    const UNITS: Units = Units { dimension: 3, lengths: [9.0, 12.0, 7.5], gaps: [0.0; 3], momentum: 1.0 };

    /// Positions everywhere, and at all bounds and next to them.
    fn positions(division: &Division) -> Vec<[u32; 3]> {
        let mut random = StdRng::seed_from_u64(5);
        let mut positions: Vec<[u32; 3]> = (0..200).map(|_| random.random()).collect();
        for rank in 0..division.ranks() {
            for axis in 0..3 {
                for off in [u32::MAX, 0, 1] {
                    let mut position: [u32; 3] = random.random();
                    position[axis] = division.domain(rank).low[axis].wrapping_add(off);
                    positions.push(position);
                }
            }
        }
        positions
    }

    #[test]
    fn every_position_has_one_owner() {
        for x in 1..=8 {
            for y in 1..=8 {
                for z in 1..=8 {
                    let division = Division { parts: [x, y, z] };
                    let domains: Vec<Domain> = (0..division.ranks()).map(|rank| division.domain(rank)).collect();
                    for position in positions(&division) {
                        let owners = domains.iter().filter(|domain| domain.contains(position)).count();
                        assert_eq!(owners, 1, "{position:?} of {division:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_rank_has_whole_rows_and_adds_to_their_nodes() {
        let mut random = StdRng::seed_from_u64(7);
        for (count, ranks, centred) in [(5, 2, false), (13, 13, true), (16, 3, true), (64, 7, false), (4093, 4, true)] {
            let (rows, division) = (Rows { count, centred }, Division { parts: [1, ranks, 1] });
            let domains: Vec<Domain> = (0..ranks).map(|rank| division.domain_of_rows(rank, rows)).collect();
            let bounds = domains.iter().flat_map(|domain| [u32::MAX, 0, 1].map(|off| domain.low[1].wrapping_add(off)));
            for y in bounds.chain((0..500).map(|_| random.random())).collect::<Vec<u32>>() {
                let owners: Vec<u32> = (0..ranks).filter(|&rank| domains[rank as usize].contains([3, y, 0])).collect();
                let shift = if centred { 1 << 31 } else { 0 };
                let row = ((u64::from(y) * u64::from(count) + shift) >> 32) as u32 % count;
                assert!(owners.len() == 1 && division.rows(owners[0], rows).contains(&row), "{y} in {rows:?}");
            }
            // Cubic splines: a row below and two above.
            let part = Part { division, rank: 0 };
            for (rank, stretch) in (0..).zip(part.stretches(rows, 10, [1, 2])) {
                let Range { start, end } = division.rows(rank, rows);
                assert_eq!(stretch.first, 10 * u64::from((start + count - 1) % count));
                assert_eq!(stretch.count, 10 * u64::from((end - start + 3).min(count)));
            }
        }
        let marked = Beyond::Marked;
        let sum = SharedSum { array: Array::NodeMasses, beyond: marked, after: 0, length: 50, stretches: Vec::new() };
        let of =
            |sum: &SharedSum, words: [i32; 3]| sum.word(words.into_iter().fold(0, |all, word| sum.with(all, word)));
        assert_eq!(
            [of(&sum, [7, -9, 4]), of(&sum, [i32::MAX, 1, 0]), of(&sum, [5, i32::MIN, 7])],
            [2, i32::MIN, i32::MIN]
        );
        // Parts of 3 000 000 000, -2 999 999 000 and -900, as words have them.
        let wrapped = SharedSum { beyond: Beyond::Wrapped, ..sum.clone() };
        let parts = [3_000_000_000_i64, -2_999_999_000, -900].map(|part| part as i32);
        assert_eq!([of(&wrapped, parts), of(&wrapped, [i32::MIN, i32::MIN, 3])], [100, 3]);
        let pieces = |first, count| sum.pieces(Stretch { first, count }).map(|piece| (piece.first, piece.count));
        assert_eq!((pieces(10, 40), pieces(40, 30)), ([(10, 40), (0, 0)], [(40, 10), (0, 20)]));
    }

    /// Whoever may interact with a particle of a domain is known there, and whoever leaves a domain in a step is known to those that
    /// need it then.
    #[test]
    fn halos_hold_what_is_near_and_peers_are_all_that_need_it() {
        let (close, reach) = (1.0, 1.0);
        let mut random = StdRng::seed_from_u64(6);
        let divisions = [[1, 1, 2], [1, 1, 3], [1, 5, 1], [2, 2, 2], [4, 5, 3]];
        // Where bonds reach beyond the next part, or round the box, more ranks are peers.
        for (parts, halo) in divisions.into_iter().flat_map(|parts| [close, 1.7, 3.0, 9.0].map(|halo| (parts, halo))) {
            let division = Division { parts };
            assert!(division.suits(&UNITS, close, reach), "{parts:?}");
            let needed = |rank: u32| division.domain(rank).with_halo(&UNITS, halo);
            for position in positions(&division) {
                let mut away = |distance: f64| -> [u32; 3] {
                    std::array::from_fn(|axis| {
                        let fraction = distance / UNITS.lengths[axis] * 2_f64.powi(32);
                        position[axis].wrapping_add((fraction * random.random_range(-1.0..1.0)) as i64 as u32)
                    })
                };
                let owner = (0..division.ranks()).find(|rank| division.domain(*rank).contains(position)).unwrap();
                assert!(needed(owner).contains(away(halo)));
                let moved = away(reach);
                for rank in (0..division.ranks()).filter(|rank| *rank != owner && needed(*rank).contains(moved)) {
                    let peers = division.peers(owner, &UNITS, halo + reach);
                    assert!(peers.contains(&rank), "{parts:?}: {owner} to {rank}");
                }
            }
        }
        // Too thin for that, or as wide as the box with their halos.
        assert!(!Division { parts: [1, 1, 4] }.suits(&UNITS, close, reach));
        assert!(!Division { parts: [1, 1, 2] }.suits(&UNITS, 2.0, reach));
        assert_eq!(Division::most_parts(&UNITS, close, reach, 2), 3);
    }

    /// The cell of a fraction on an axis, as shaders/grid/dimension finds it.
    fn cell_along(fraction: u32, number: u32) -> u32 {
        (((fraction >> 8) as f32 * (number as f32 / 16_777_216.0)) as u32).min(number - 1)
    }

    /// A domain that ends at the faces of cells, which single precision does not find to the last bit.
    #[test]
    fn cells_lie_within_a_domain_and_around_it_however_they_are_rounded() {
        for number in [3_u32, 7, 29, 700, 1024] {
            let face = |cell: u32| ((u64::from(cell) << 32).div_ceil(number.into())) as u32;
            for cell in 0..number {
                let domain = Domain {
                    low: [0, 0, face(cell), 0],
                    width: [0, 0, face((cell + 2) % number).wrapping_sub(face(cell)), 0],
                };
                let cells = [1, 1, number];
                let place = |z: u32, block: &Cells| (cell_along(z, number) + number - block.first[2]) % number;
                let (within, around) = (domain.cells_within(cells), domain.cells_around(cells));
                for end in [domain.low[2], domain.low[2].wrapping_add(domain.width[2])] {
                    for z in (0..600).map(|off: u32| end.wrapping_add(off).wrapping_sub(300)) {
                        let inside = domain.contains([0, 0, z]);
                        assert!(
                            !inside || place(z, &around) < around.count[2],
                            "{z} in two of {number} cells from {cell}"
                        );
                        let found =
                            cell + 2 <= number && within.is_some_and(|within| place(z, &within) < within.count[2]);
                        assert!(!found || inside, "{z} in two of {number} cells from {cell}");
                    }
                }
            }
        }
    }

    /// Nobody leaves inner cells for where another rank has to know of it, and all that a rank knows is in the cells around it.
    #[test]
    fn inner_cells_are_nobody_elses_and_cells_around_hold_all() {
        let (halo, reach) = (1.0, 1.0);
        let mut random = StdRng::seed_from_u64(8);
        let units = Units { lengths: [16.0, 22.0, 30.0], ..UNITS };
        let mut inside = 0;
        for (parts, cells) in [
            ([1, 1, 2], [16, 22, 30]),
            ([1, 3, 2], [13, 17, 29]),
            ([2, 2, 3], [11, 22, 27]),
            ([1, 2, 1], [1, 1024, 1]),
            ([2, 1, 1], [700, 3, 1]),
        ] {
            let division = Division { parts };
            for rank in 0..division.ranks() {
                let own = division.domain(rank);
                let needed = own.with_halo(&units, halo);
                let around = needed.cells_around(cells);
                let inner = own.without_edge(&units, halo + reach).unwrap().cells_within(cells).unwrap();
                // A part less two widths on both sides, and at most two cells that are cut.
                for axis in (0..3).filter(|axis| parts[*axis] > 1) {
                    let left = units.lengths[axis] / f64::from(parts[axis]) - 4.0;
                    assert!(f64::from(inner.count[axis]) > left / units.lengths[axis] * f64::from(cells[axis]) - 2.001);
                }
                let peers = division.peers(rank, &units, halo + reach).into_iter();
                let theirs: Vec<Domain> = peers.map(|peer| division.domain(peer).with_halo(&units, halo)).collect();
                // At the faces of all cells, and everywhere.
                let faces = (0..3).flat_map(|axis| (0..cells[axis]).map(move |cell| (axis, cell)));
                let at_faces: Vec<[u32; 3]> = faces
                    .flat_map(|(axis, cell)| [-300_i64, -1, 0, 1, 300].map(|off| (axis, cell, off)))
                    .map(|(axis, cell, off)| {
                        let mut position: [u32; 3] = random.random();
                        let face = (u64::from(cell) << 32).div_ceil(cells[axis].into()) as u32;
                        position[axis] = face.wrapping_add(off as u32);
                        position
                    })
                    .collect();
                for position in positions(&division).into_iter().chain(at_faces) {
                    let cell: [u32; 3] = std::array::from_fn(|axis| cell_along(position[axis], cells[axis]));
                    let among = |block: &Cells| {
                        let place = |axis: usize| (cell[axis] + cells[axis] - block.first[axis]) % cells[axis];
                        (0..3).all(|axis| place(axis) < block.count[axis])
                    };
                    assert!(among(&around) || !needed.contains(position), "{position:?} of {rank} in {parts:?}");
                    if !among(&inner) {
                        continue;
                    }
                    inside += 1;
                    assert!(among(&around) && own.contains(position));
                    for _ in 0..8 {
                        let moved: [u32; 3] = std::array::from_fn(|axis| {
                            let way = [-1.0, 1.0, random.random_range(-1.0..1.0)][random.random_range(0..3)];
                            let fraction = reach * way / units.lengths[axis] * 2_f64.powi(32);
                            position[axis].wrapping_add(fraction as i64 as u32)
                        });
                        assert!(own.contains(moved), "{position:?} to {moved:?} of {rank} in {parts:?}");
                        let known = theirs.iter().any(|domain| domain.contains(moved));
                        assert!(!known, "{position:?} to {moved:?} of {rank} in {parts:?}");
                    }
                }
            }
        }
        assert!(inside > 1000, "{inside}");
        // Nothing is left of parts that are no wider than their edges.
        assert_eq!(Division { parts: [1, 1, 8] }.domain(3).without_edge(&units, halo + reach), None);
    }
}
