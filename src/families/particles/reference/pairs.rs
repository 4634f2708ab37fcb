//! Which particles interact, and the numbers of a pair that every integrator needs.

use super::Images;
use super::potential::Potential;
use crate::document::Distribution;
use crate::families::Model;
use crate::noise;

/// Two particles within range of each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pair {
    /// Smaller id i.
    pub first: usize,
    /// Larger id j.
    pub second: usize,
    /// rᵢ - rⱼ, by the nearest image.
    pub separation: [f64; 3],
    /// |rᵢ - rⱼ|.
    pub distance: f64,
    /// By how many boxes the image of j is above j across boundaries that shear.
    pub boxes_up: i64,
}

impl Pair {
    /// Two particles where they are, i < j or the ends of a bond.
    pub(crate) fn of(images: &Images<'_>, positions: &[[u32; 3]], first: usize, second: usize) -> Self {
        let (separation, boxes_up) = images.displacement(positions[first], positions[second]);
        Self { first, second, separation, distance: dot(separation, separation).sqrt(), boxes_up }
    }

    /// The unit vector e along rᵢ - rⱼ. Two particles in the same place have none: e = 0, and they exert no force.
    pub(crate) fn direction(&self) -> [f64; 3] {
        if self.distance == 0.0 { [0.0; 3] } else { self.separation.map(|component| component / self.distance) }
    }
}

/// All pairs closer than `range`, which is at most half of every box edge or sees nearest images only.
pub(crate) fn find_pairs(images: &Images<'_>, positions: &[[u32; 3]], range: f64) -> Vec<Pair> {
    let mut found = Vec::with_capacity(4 * positions.len());
    visit_pairs(images, positions, range, &mut |pair| found.push(pair));
    found
}

/// The pairs of a step that are closer than `range`, but for those through the space behind walls.
pub(crate) fn close_pairs(model: &Model, step: u64, positions: &[[u32; 3]], range: f64, visit: &mut dyn FnMut(Pair)) {
    let through = |pair: &Pair| {
        let apart = |axis: usize| positions[pair.first][axis].abs_diff(positions[pair.second][axis]);
        model.particles().walls.iter().any(|walls| apart(walls.axis) >= 1 << 31)
    };
    visit_pairs(&Images::of_step(model, step), positions, range, &mut |pair| {
        if !through(&pair) {
            visit(pair);
        }
    });
}

fn visit_pairs(images: &Images<'_>, positions: &[[u32; 3]], range: f64, visit: &mut dyn FnMut(Pair)) {
    let units = images.units;
    let dimension = units.dimension;
    // Smaller cells than this would mostly be empty.
    let most = (positions.len() as f64).powf(1.0 / dimension as f64).ceil().max(3.0);
    let mut cells = [1_usize; 3];
    for (cells, length) in cells.iter_mut().zip(units.lengths).take(dimension) {
        *cells = (length / range).floor().min(most) as usize;
    }
    let mut pairs = Pairs { images, range_squared: range * range, visit };
    if cells[..dimension].iter().all(|&cells| cells >= 3) && !images.shear() {
        linked_cells(positions, cells, dimension, &mut pairs);
    } else {
        for second in 0..positions.len() {
            for first in 0..second {
                pairs.consider(first, second, positions[first], positions[second]);
            }
        }
    }
}

struct Pairs<'a> {
    images: &'a Images<'a>,
    range_squared: f64,
    visit: &'a mut dyn FnMut(Pair),
}

impl Pairs<'_> {
    #[inline]
    fn consider(&mut self, i: usize, j: usize, position_i: [u32; 3], position_j: [u32; 3]) {
        let (separation, boxes_up) = self.images.displacement(position_i, position_j);
        let squared = dot(separation, separation);
        if squared < self.range_squared {
            let distance = squared.sqrt();
            (self.visit)(if i < j {
                Pair { first: i, second: j, separation, distance, boxes_up }
            } else {
                let separation = separation.map(|component| -component);
                Pair { first: j, second: i, separation, distance, boxes_up: -boxes_up }
            });
        }
    }
}

/// Considers every pair of particles in the same or in adjacent cells once; at least three cells lie along each axis.
fn linked_cells(positions: &[[u32; 3]], cells: [usize; 3], dimension: usize, pairs: &mut Pairs) {
    let cell_of = |position: &[u32; 3]| {
        let [x, y, z]: [usize; 3] =
            std::array::from_fn(|axis| ((u64::from(position[axis]) * cells[axis] as u64) >> 32) as usize);
        (z * cells[1] + y) * cells[0] + x
    };
    let mut starts = vec![0_usize; cells.iter().product::<usize>() + 1];
    for position in positions {
        starts[cell_of(position) + 1] += 1;
    }
    for cell in 1..starts.len() {
        starts[cell] += starts[cell - 1];
    }
    let mut next = starts.clone();
    let mut sorted = vec![(0_usize, [0_u32; 3]); positions.len()];
    for (id, position) in positions.iter().enumerate() {
        let slot = &mut next[cell_of(position)];
        sorted[*slot] = (id, *position);
        *slot += 1;
    }
    let members = |cell: usize| &sorted[starts[cell]..starts[cell + 1]];
    let stencil = half_stencil(dimension);
    for z in 0..cells[2] {
        for y in 0..cells[1] {
            for x in 0..cells[0] {
                let here = members((z * cells[1] + y) * cells[0] + x);
                for (index, &(i, position_i)) in here.iter().enumerate() {
                    for &(j, position_j) in &here[..index] {
                        pairs.consider(i, j, position_i, position_j);
                    }
                }
                for offset in &stencil {
                    let [x, y, z]: [usize; 3] = std::array::from_fn(|axis| {
                        ([x, y, z][axis] + cells[axis]).wrapping_add_signed(offset[axis]) % cells[axis]
                    });
                    let there = members((z * cells[1] + y) * cells[0] + x);
                    for &(i, position_i) in here {
                        for &(j, position_j) in there {
                            pairs.consider(i, j, position_i, position_j);
                        }
                    }
                }
            }
        }
    }
}

/// Of each two opposite neighbours of a cell, one: 13 in three dimensions, 4 in two, 1 in one.
fn half_stencil(dimension: usize) -> Vec<[isize; 3]> {
    let mut stencil = Vec::new();
    for z in -1..=1_isize {
        for y in -1..=1_isize {
            for x in -1..=1_isize {
                if [z, y, x] > [0, 0, 0] && [x, y, z][dimension..].iter().all(|&offset| offset == 0) {
                    stencil.push([x, y, z]);
                }
            }
        }
    }
    stencil
}

/// The pair forces of the model at one distance.
#[derive(Default)]
pub(crate) struct Forces {
    /// The conservative force.
    pub potential: Potential,
    /// Friction coefficient γ of the two species.
    pub friction: f64,
    /// w = √ω, the weight of the noise.
    pub weight: f64,
}

impl Forces {
    /// The forces between two particles; none at all without a pair force, and each within its own cutoff.
    pub(crate) fn between(model: &Model, species: &[u32], pair: &Pair) -> Self {
        let Some(force) = model.particles().pair_force.as_ref() else { return Self::default() };
        let [a, b] = [species[pair.first] as usize, species[pair.second] as usize];
        let potential = Potential::of_pair(force, [a, b], pair.distance);
        let (cutoff, exponent) = (force.friction_cutoff(a, b), force.weight_exponent(a, b));
        if pair.distance >= cutoff {
            return Self { potential, ..Self::default() };
        }
        let closeness = 1.0 - pair.distance / cutoff;
        let weight = if exponent == 2.0 { closeness } else { closeness.powf(exponent / 2.0) };
        Self { potential, friction: force.friction(a, b), weight }
    }
}

/// The noise ζ of a pair, of zero mean and unit variance, under a step's key.
pub(crate) fn noise(model: &Model, key: [u32; 2], pair: &Pair) -> f64 {
    let words = noise::words(model.generator, key, [pair.first as u32, pair.second as u32]);
    match model.distribution {
        Distribution::Uniform => 12.0_f64.sqrt() * noise::centred_uniform(words[0]),
        Distribution::Gaussian => noise::gaussian(words),
    }
}

/// Gives an impulse to particle i and takes it from particle j, rounded once, half to even, to whole units.
pub(crate) fn exchange(sums: &mut [[i64; 3]], pair: &Pair, impulse: [f64; 3], unit: f64) {
    for axis in 0..3 {
        // A hundred thousand such impulses still fit a sum, and one of them is already too much for a momentum.
        let whole = (impulse[axis] / unit).round_ties_even().clamp(-MOST_UNITS, MOST_UNITS) as i64;
        sums[pair.first][axis] += whole;
        sums[pair.second][axis] -= whole;
    }
}

pub(crate) const MOST_UNITS: f64 = (1_u64 << 44) as f64;

/// Scalar product.
#[inline]
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Units;

    fn scattered(count: u32, dimension: usize) -> Vec<[u32; 3]> {
        (0..count)
            .map(|id| {
                let [x, y, z, _] = noise::pcg4d([id, 7, 7, 7]);
                let position = [x, y, z];
                std::array::from_fn(|axis| if axis < dimension { position[axis] } else { 0 })
            })
            .collect()
    }

    #[test]
    fn linked_cells_find_what_all_pairs_find() {
        for (lengths, dimension) in [
            ([3.0, 3.0, 3.0], 3),
            ([3.1, 4.7, 9.2], 3),
            ([6.0, 3.5, 1.0], 2),
            ([40.0, 40.0, 40.0], 3),
            ([50.0, 1.0, 1.0], 1),
        ] {
            let units = Units { dimension, lengths, gaps: [0.0; 3], momentum: 1.0 };
            let positions = scattered(300, dimension);
            let images = Images::at_rest(&units);
            let mut found: Vec<_> = find_pairs(&images, &positions, 1.0);
            found.sort_by_key(|pair| (pair.second, pair.first));
            let mut expected = Vec::new();
            let mut all = Pairs { images: &images, range_squared: 1.0, visit: &mut |pair| expected.push(pair) };
            for j in 0..positions.len() {
                for i in 0..j {
                    all.consider(i, j, positions[i], positions[j]);
                }
            }
            assert!(!found.is_empty(), "{lengths:?}");
            assert_eq!(found, expected, "{lengths:?}");
        }
    }

    #[test]
    fn coincident_particles_have_no_direction() {
        let units = Units { dimension: 3, lengths: [4.0; 3], gaps: [0.0; 3], momentum: 1.0 };
        let pairs = find_pairs(&Images::at_rest(&units), &[[5, 6, 7], [5, 6, 7]], 1.0);
        assert_eq!(pairs.len(), 1);
        assert_eq!(pairs[0].direction(), [0.0; 3]);
    }

    #[test]
    fn an_impulse_is_rounded_alike_for_both_ends() {
        let pair = Pair { first: 0, second: 1, separation: [1.0, 0.0, 0.0], distance: 1.0, boxes_up: 0 };
        let mut sums = [[0; 3]; 2];
        exchange(&mut sums, &pair, [1.25, -0.75, 0.3], 0.5);
        assert_eq!(sums, [[2, -2, 1], [-2, 2, -1]]);
    }
}
