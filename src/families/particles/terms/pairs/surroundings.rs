//! How dense it is around particles, from where they start.
//!
//! Laws that take the mean density of the box for that of its particles know nothing of a drop in a large box. Where a start says where its
//! particles are, neighbours are counted. Those laws are about fluids, in which chance alone gives some particles twice as many neighbours as
//! others: a density is one that the counts n come from. Of counts that chance spreads as Poisson has it, the factorial moments
//! ⟨n(n-1)…(n-k+1)⟩ are the moments ⟨λᵏ⟩ of what is expected, so that ⟨λ⁵⟩/⟨λ⁴⟩ is the mean of an even fluid, and where the density
//! varies, the one of the densest places.

use super::PairForce;
use crate::document::{FileStart, ParticleGroup, Placement, Scene, Surroundings};
use crate::families::Species;
use crate::families::particles::index_of;
use std::f64::consts::PI;

/// Particles whose neighbours are counted, at most; of more, some.
const MOST_CENTRES: usize = 1 << 13;

/// Particles that are looked at for that, at most and about: where thousands lie in a cell, a few centres have as many neighbours as many have
/// in a fluid.
const MOST_VISITS: f64 = 1e8;

/// The order k of the moments.
const ORDER: u32 = 4;

/// A fraction of an edge, in the units of integer positions.
const EDGE: f64 = 4_294_967_296.0;

/// Particles in a periodic box.
pub(crate) struct Crowd<'a> {
    /// Their places as fractions of the box, in units of 2⁻³².
    pub places: &'a [[u32; 3]],
    /// Their species.
    pub species: &'a [u8],
    /// Edges of the box, one for each dimension.
    pub lengths: &'a [f64],
    /// Densities of other particles, species by species, which are anywhere.
    pub even: Vec<f64>,
}

/// The surroundings of particles that a scene lists or a file has; none where they start evenly, or without a pair force.
pub(crate) fn of(scene: &Scene, species: &[Species], force: &PairForce) -> Option<Surroundings> {
    if let Some(start) = scene.start() {
        return start.surroundings.clone();
    }
    let are_listed =
        |group: &ParticleGroup| matches!(group.placement, Placement::Listed { .. } | Placement::Circle { .. });
    if !scene.particles.iter().any(are_listed) {
        return None;
    }
    let lengths = &scene.space.lengths;
    let (mut places, mut of_places) = (Vec::new(), Vec::new());
    let mut even = vec![0.0; species.len()];
    for group in &scene.particles {
        let kind = index_of(species, &group.species).unwrap_or(0);
        let count = group.resolved_count(&scene.space);
        let place = |position: [f64; 3]| {
            std::array::from_fn(|axis| match lengths.get(axis) {
                Some(edge) => ((position[axis] / edge).rem_euclid(1.0) * EDGE) as u64 as u32,
                None => 0,
            })
        };
        match &group.placement {
            Placement::Listed { .. } | Placement::Circle { .. } => {
                places.extend((0..count).filter_map(|index| group.placement.position(index, count)).map(place));
            }
            _ if group.is_frozen() => {}
            _ => even[kind] += count as f64 / scene.space.volume(),
        }
        of_places.resize(places.len(), kind as u8);
    }
    Some(Crowd { places: &places, species: &of_places, lengths, even }.surroundings(force.cutoff))
}

impl Crowd<'_> {
    /// Densities within a range of particles.
    pub(crate) fn surroundings(&self, range: f64) -> Surroundings {
        let kinds = self.even.len();
        let shortest = self.lengths.iter().copied().fold(f64::INFINITY, f64::min);
        // Farther away a particle has images that are nearer.
        let range = range.min(0.5 * shortest);
        let ball = match self.lengths.len() {
            1 => 2.0 * range,
            2 => PI * range * range,
            _ => 4.0 / 3.0 * PI * range.powi(3),
        };
        let cells = Cells::of(self, range);
        let centres = ((MOST_VISITS / cells.visits()) as usize).clamp(1, MOST_CENTRES);
        let step = self.places.len().div_ceil(centres).max(1);
        let mut counts: Vec<Vec<Vec<u32>>> = vec![Vec::new(); kinds];
        for centre in (0..self.places.len()).step_by(step) {
            let mut found = vec![0; kinds];
            cells.visit(self, centre, range, |other| found[usize::from(self.species[other])] += 1);
            counts[usize::from(self.species[centre])].push(found);
        }
        let centres: usize = counts.iter().map(Vec::len).sum();
        let neighbours: f64 = counts.iter().flatten().flatten().map(|count| f64::from(*count)).sum();
        let evenly: f64 = self.even.iter().sum();
        let densest = counts.iter().map(|counts| {
            // Around no particle there is none.
            let mut densities = if counts.is_empty() { vec![0.0; kinds] } else { densities(counts, ball) };
            for (density, even) in densities.iter_mut().zip(&self.even) {
                *density += even;
            }
            densities
        });
        let mut densest: Vec<Vec<f64>> = densest.collect();
        // What is anywhere is in the densest places too.
        let total = |densities: &Vec<f64>| densities.iter().sum::<f64>();
        let of_all = densest.iter().max_by(|a, b| total(a).total_cmp(&total(b))).cloned();
        for (kind, of_kind) in densest.iter_mut().enumerate().filter(|(kind, _)| counts[*kind].is_empty()) {
            if self.even[kind] > 0.0 {
                of_kind.clone_from(of_all.as_ref().unwrap_or(&self.even));
            }
        }
        Surroundings { densest, mean: neighbours / centres.max(1) as f64 / ball + evenly }
    }
}

/// Densities of all species in the densest places of some particles, from the numbers of their neighbours.
fn densities(counts: &[Vec<u32>], ball: f64) -> Vec<f64> {
    let kinds = counts.first().map_or(0, Vec::len);
    let total = |count: &Vec<u32>| f64::from(count.iter().sum::<u32>());
    let falling = |from: f64, order: u32| (0..order).map(|less| (from - f64::from(less)).max(0.0)).product::<f64>();
    let moment = |order: u32| counts.iter().map(|count| falling(total(count), order)).sum::<f64>();
    let mean = moment(1) / counts.len().max(1) as f64;
    let dense = moment(ORDER + 1) / moment(ORDER);
    // Particles on a lattice have all the same number, which chance does not spread.
    let expected = if dense > mean { dense } else { mean };
    let is_dense = dense > mean;
    let weight = |count: &Vec<u32>| if is_dense { falling(total(count) - 1.0, ORDER) } else { 1.0 };
    let of_kind = |kind: usize| counts.iter().map(|count| weight(count) * f64::from(count[kind])).sum::<f64>();
    let all: f64 = (0..kinds).map(of_kind).sum();
    (0..kinds).map(|kind| if all > 0.0 { of_kind(kind) / all * expected / ball } else { 0.0 }).collect()
}

/// Cells at least as wide as the range of what is counted, in which there are particles.
struct Cells {
    numbers: [u64; 3],
    /// Particles in order of their cells.
    order: Vec<(u64, u32)>,
    /// Where each cell begins that has particles.
    starts: Vec<(u64, usize)>,
}

impl Cells {
    /// The most cells along an axis.
    const MOST: f64 = (1 << 20) as f64;

    fn of(crowd: &Crowd<'_>, range: f64) -> Self {
        let numbers = std::array::from_fn(|axis| {
            crowd.lengths.get(axis).map_or(1, |edge| (edge / range).floor().clamp(1.0, Self::MOST) as u64)
        });
        let mut cells = Self { numbers, order: Vec::new(), starts: Vec::new() };
        cells.order =
            crowd.places.iter().zip(0..).map(|(place, number)| (cells.key(cells.cell(*place)), number)).collect();
        cells.order.sort_unstable();
        for (at, (key, _)) in cells.order.iter().enumerate() {
            if cells.starts.last().is_none_or(|(last, _)| last != key) {
                cells.starts.push((*key, at));
            }
        }
        cells
    }

    /// Particles that are looked at for the neighbours of one, on average, where cells beside each other are alike.
    fn visits(&self) -> f64 {
        let ends = self.starts.iter().skip(1).map(|(_, start)| *start).chain([self.order.len()]);
        let squares: f64 = self.starts.iter().zip(ends).map(|((_, start), end)| ((end - start) as f64).powi(2)).sum();
        let near = self.numbers.iter().map(|number| *number.min(&3) as f64).product::<f64>();
        (near * squares / self.order.len().max(1) as f64).max(1.0)
    }

    fn cell(&self, place: [u32; 3]) -> [u64; 3] {
        std::array::from_fn(|axis| (u64::from(place[axis]) * self.numbers[axis]) >> 32)
    }

    fn key(&self, [x, y, z]: [u64; 3]) -> u64 {
        (z * self.numbers[1] + y) * self.numbers[0] + x
    }

    /// Visits the neighbours of a particle.
    fn visit(&self, crowd: &Crowd<'_>, centre: usize, range: f64, mut see: impl FnMut(usize)) {
        let here = crowd.places[centre];
        let cell = self.cell(here);
        // Of one or two cells along an axis each is met once.
        let near: [Vec<u64>; 3] = std::array::from_fn(|axis| {
            let number = self.numbers[axis];
            (0..number.min(3)).map(|step| (cell[axis] + number + step - u64::from(number > 2)) % number).collect()
        });
        let is_near = |other: &[u32; 3]| {
            let apart = crowd
                .lengths
                .iter()
                .enumerate()
                .map(|(axis, edge)| f64::from(here[axis].wrapping_sub(other[axis]).cast_signed()) * edge / EDGE);
            apart.map(|part| part * part).sum::<f64>() < range * range
        };
        for z in &near[2] {
            for y in &near[1] {
                for x in &near[0] {
                    let key = self.key([*x, *y, *z]);
                    let Ok(at) = self.starts.binary_search_by_key(&key, |(key, _)| *key) else { continue };
                    let end = self.starts.get(at + 1).map_or(self.order.len(), |(_, start)| *start);
                    for (_, other) in &self.order[self.starts[at].1..end] {
                        let other = *other as usize;
                        if other != centre && is_near(&crowd.places[other]) {
                            see(other);
                        }
                    }
                }
            }
        }
    }
}

/// How dense it is around the particles of a file or of molecules in a box of these edges; nothing without a pair
/// force.
pub(crate) fn of_start(scene: &Scene, start: &FileStart, lengths: &[f64]) -> Option<Surroundings> {
    let places = start.places.as_ref()?;
    let species = Species::of(scene);
    let force = PairForce::of_scene(scene, &species, lengths.len());
    let crowd = Crowd { places: &places.positions, species: &start.species, lengths, even: vec![0.0; species.len()] };
    force.map(|force| crowd.surroundings(force.cutoff))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::{self};
    use crate::scene;
    use rand::rngs::StdRng;
    use rand::{RngExt as _, SeedableRng as _};

    fn crowd(lengths: &[f64], places: &[[f64; 3]], species: &[u8], even: Vec<f64>, range: f64) -> Surroundings {
        let place = |place: &[f64; 3]| {
            std::array::from_fn(|axis| lengths.get(axis).map_or(0, |edge| (place[axis] / edge * EDGE) as u64 as u32))
        };
        let places: Vec<[u32; 3]> = places.iter().map(place).collect();
        Crowd { places: &places, species, lengths, even }.surroundings(range)
    }

    /// An even fluid has its mean density, a lattice that of its neighbours, and a dense part in a thin one its own.
    #[test]
    fn densities_are_those_that_counts_come_from() {
        let mut random = StdRng::seed_from_u64(5);
        let mut evenly = |count: usize, low: f64, high: f64| -> Vec<[f64; 3]> {
            (0..count).map(|_| std::array::from_fn(|_| random.random_range(low..high))).collect()
        };
        let fluid = evenly(3000, 0.0, 10.0);
        let found = crowd(&[10.0; 3], &fluid, &[0; 3000], vec![0.0], 1.0);
        // 3000 particles with 12.6 neighbours: the pairs spread by 1 %; a higher moment by some 3 %.
        assert!((found.mean - 3.0).abs() < 0.1 && (found.densest[0][0] - 3.0).abs() < 0.3, "{found:?}");
        let lattice: Vec<[f64; 3]> =
            (0..1000).map(|at| [at % 10, at / 10 % 10, at / 100].map(|at| f64::from(at) + 0.5)).collect();
        // 18 sites lie within 1.5.
        let found = crowd(&[10.0; 3], &lattice, &[0; 1000], vec![0.0], 1.5);
        let sites = 18.0 / (4.0 / 3.0 * PI * 1.5_f64.powi(3));
        assert!((found.mean - sites).abs() < 1e-12 && (found.densest[0][0] - sites).abs() < 1e-12, "{found:?}");
        // A cube of density 9 with an edge of 6 in a gas of .01, whose faces have half as many neighbours.
        let drop = [evenly(1944, 20.0, 26.0), evenly(1000, 0.0, 46.0)].concat();
        let found = crowd(&[46.0; 3], &drop, &[0; 2944], vec![0.0], 1.0);
        assert!((7.5..9.5).contains(&found.densest[0][0]), "{found:?}");
    }

    /// Fewer centres are counted where more particles lie around each.
    #[test]
    fn crowds_are_counted_from_fewer_places() {
        let mut random = StdRng::seed_from_u64(7);
        let places: Vec<[u32; 3]> = (0..40_000).map(|_| std::array::from_fn(|_| random.random())).collect();
        let visits = |lengths: &[f64], places: &[[u32; 3]]| {
            let species = vec![0; places.len()];
            Cells::of(&Crowd { places, species: &species, lengths, even: vec![0.0] }, 1.0).visits()
        };
        // All are near each other in two cells along an axis; 27 of a thousand cells hold 2.7 %, and chance adds a particle to each.
        assert!((visits(&[2.0; 3], &places) / 40_000.0 - 1.0).abs() < 0.01);
        assert!((visits(&[10.0; 3], &places) / (27.0 * 41.0) - 1.0).abs() < 0.01);
        assert_eq!(visits(&[1000.0; 3], &[[5; 3]; 100]), 2700.0);
        let found = crowd(&[2.0; 3], &vec![[1.0; 3]; 20_000], &vec![0; 20_000], vec![0.0], 1.0);
        assert!((found.mean / 19_999.0 * (4.0 / 3.0 * PI) - 1.0).abs() < 1e-12, "{found:?}");
    }

    /// Species have surroundings of their own, and what is spread evenly meets the densest.
    #[test]
    fn species_have_their_own_surroundings() {
        let mut random = StdRng::seed_from_u64(6);
        let mut places: Vec<[f64; 3]> = Vec::new();
        for (low, count) in [(0.0, 1000), (10.0, 500)] {
            places.extend((0..count).map(|_| {
                let [x, y] = std::array::from_fn(|_| random.random_range(0.0..10.0));
                [low + x, y, 0.0]
            }));
        }
        let species: Vec<u8> = (0..1500).map(|particle| u8::from(particle >= 1000)).collect();
        let found = crowd(&[20.0, 10.0], &places, &species, vec![0.0, 0.0, 0.25], 1.0);
        let expected = [[10.0, 0.0], [0.0, 5.0]];
        for (kind, expected) in expected.iter().enumerate() {
            for (other, expected) in expected.iter().enumerate() {
                let density = found.densest[kind][other];
                assert!((density - expected).abs() < 1.0, "{kind} {other}: {density}");
            }
        }
        assert_eq!(found.densest[2], found.densest[0]);
        assert!(found.densest.iter().all(|of_kind| of_kind[2] == 0.25), "{found:?}");
    }

    /// Counted one by one, in boxes of one, two and more cells along an axis.
    #[test]
    fn neighbours_are_counted_round_the_box() {
        let mut random = StdRng::seed_from_u64(7);
        for lengths in [[2.1, 5.3, 4.2], [2.0, 2.9, 9.0], [3.0, 6.5, 2.2]] {
            let places: Vec<[f64; 3]> = (0..200).map(|_| lengths.map(|edge| random.random_range(0.0..edge))).collect();
            let near = |a: &[f64; 3], b: &[f64; 3]| {
                let apart = (0..3).map(|axis| {
                    let apart = (a[axis] - b[axis]).abs();
                    apart.min(lengths[axis] - apart).powi(2)
                });
                apart.sum::<f64>() < 1.0
            };
            let pairs: usize = places.iter().map(|a| places.iter().filter(|b| near(a, b)).count() - 1).sum();
            let found = crowd(&lengths, &places, &[0; 200], vec![0.0], 1.0);
            assert!((found.mean * 4.0 / 3.0 * PI * 200.0 - pairs as f64).abs() < 1e-6, "{lengths:?}");
        }
    }

    /// Laws, warnings and costs are those of a drop in a large box, listed or in a file, and after its run has been resumed.
    #[test]
    fn a_drop_in_a_large_box_is_dense() {
        let mut random = StdRng::seed_from_u64(8);
        let places: Vec<[f64; 3]> =
            (0..600).map(|_| std::array::from_fn(|_| random.random_range(48.0..52.0))).collect();
        let scene = |state: serde_json::Value, group: serde_json::Value| {
            serde_json::json!({
                "title": "a drop", "space": {"box": [100, 100, 100]}, "time": {"step": 0.05, "steps": 40}, "temperature": 1,
                "state": state, "particles": [group], "interactions": [{"type": "dpd", "repulsion": 60, "friction": 60}],
            })
        };
        let placement = serde_json::json!({"type": "listed", "positions": places});
        let listed = scene(serde_json::Value::Null, serde_json::json!({"species": "A", "placement": placement}));
        let directory = tempfile::tempdir().unwrap();
        let lines = places.iter().map(|[x, y, z]| format!("A {x} {y} {z}\n"));
        std::fs::write(directory.path().join("a.xyz"), format!("600\nno keys\n{}", lines.collect::<String>())).unwrap();
        let state = serde_json::json!({"file": "a.xyz", "velocities": "thermal"});
        let name = directory.path().join("scene.json");
        let of_file = scene(state, serde_json::json!({"species": "A"}));
        let parsed =
            [listed, of_file].map(|text| scene::parse(name.to_str().unwrap(), &text.to_string(), &[]).unwrap());
        for scene in &parsed {
            let model = scene.model();
            let force = model.particles().pair_force.as_ref().unwrap();
            // Evenly and without an end, 600 in 64 have a rate of γρ·8π/60/3, 78.5; the mean of all, near faces too, is .74 of that.
            let rate = model.largest_friction_rate(force).0;
            assert!((58.0..82.0).contains(&rate), "{rate}");
            assert!((6.0..8.0).contains(&model.density_around()), "{}", model.density_around());
            let warnings = families::warnings(scene);
            assert!(
                warnings.iter().any(|warning| warning.message.contains("friction relaxes the velocities")),
                "{warnings:?}"
            );
        }
        let [listed, of_file] = parsed.each_ref().map(|scene| scene.model().particles().surroundings.clone().unwrap());
        assert!((listed.mean / of_file.mean - 1.0).abs() < 1e-3, "{} {}", listed.mean, of_file.mean);
        let start = parsed[1].start().unwrap();
        let kept = crate::document::FileStart::from_bytes(&start.to_bytes()).unwrap();
        assert_eq!(kept.surroundings, start.surroundings);
        let even = serde_json::json!({"species": "A", "count": 600});
        let even = scene::parse("even", &scene(serde_json::Value::Null, even).to_string(), &[]).unwrap();
        assert!(even.model().particles().surroundings.is_none() && families::warnings(&even).is_empty());
    }
}
