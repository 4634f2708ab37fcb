//! The box divided among several ranks: who advances a particle, and who else has to know it.
//!
//! A position alone decides. Domains are bounded by integers, so that every adapter finds the same; a rank stores its own particles
//! and copies of those within a halo around its domain.

use crate::state::Units;

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

/// Bounds have to be beyond the cutoff as single precision finds it.
const MARGIN: f64 = 1.0 + 1e-5;

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

    /// The ranks around a rank with anything nearer to its part than a distance, each once and without it.
    #[must_use]
    pub fn peers(&self, rank: u32, units: &Units, distance: f64) -> Vec<u32> {
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
    pub fn suits(&self, units: &Units, halo: f64, reach: f64) -> bool {
        (0..3).all(|axis| self.parts[axis] <= Self::most_parts(units, halo, reach, axis))
    }

    /// The most parts of an axis that suit.
    #[must_use]
    pub fn most_parts(units: &Units, halo: f64, reach: f64, axis: usize) -> u32 {
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
    #[must_use]
    pub fn with_halo(mut self, units: &Units, distance: f64) -> Self {
        for axis in 0..3 {
            if self.width[axis] == 0 {
                continue;
            }
            let halo = (distance * MARGIN / units.lengths[axis] * 2_f64.powi(32)).ceil() as u64 + 1;
            let width = u64::from(self.width[axis]) + 2 * halo;
            self.low[axis] = self.low[axis].wrapping_sub(halo as u32);
            self.width[axis] = u32::try_from(width).unwrap_or(0);
        }
        self
    }

    /// Whether it is the whole box.
    #[must_use]
    pub fn is_whole(&self) -> bool {
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
    #[must_use]
    pub fn share(&self) -> f64 {
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
    /// Particles that it can store.
    pub slots: u64,
    /// Particles that it can send to a peer in a step.
    pub room: u64,
    /// The kernel after which particles are exchanged, as an index into [`super::Plan::kernels`].
    pub exchange: usize,
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
}

impl Part {
    /// Plans it for a number of particles, all over the box, none of which goes further in a step than `reach`; `growth` doublings more are
    /// expected in one place.
    pub(crate) fn plan(self, units: &Units, halo: Halo, reach: f64, particles: u64, growth: u32) -> PlannedPart {
        let Self { division, rank } = self;
        let Halo { close, width: halo, bonded } = halo;
        let own = division.domain(rank);
        let peers = division.peers(rank, units, halo + reach);
        let needed = own.with_halo(units, halo);
        let of_peers = peers.iter().map(|peer| division.domain(*peer).with_halo(units, halo));
        let of_bonds = bonded.map(|bonded| own.with_halo(units, bonded));
        // A fifth more than on average, and some; all of them at most.
        let expected = |share: f64| {
            let some = (1.2 * share * particles as f64) as u64 + 1024;
            some.saturating_mul(1 << growth.min(32)).min(particles)
        };
        let ghosts = needed.share() - own.share();
        // Those of this step, and what arrives for the next before the copies are forgotten.
        let slots = expected(needed.share()) + expected(ghosts);
        // To one of its peers it sends no more than lies in the halo of that, or all that it has if the peer sees its whole domain.
        let room = expected(ghosts.min(own.share()));
        PlannedPart {
            part: self,
            domains: [own, needed].into_iter().chain(of_peers).chain(of_bonds).collect(),
            peers,
            halo,
            close,
            slots,
            room,
            exchange: 0,
        }
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
}
