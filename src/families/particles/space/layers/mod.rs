//! Frozen particles in layers behind walls: where they are, and the momenta that their walls carry them with.

pub(crate) mod scene;

use crate::document::{Generator, Placement, WallSide};
use crate::families::{Model, PlaneWalls};
use crate::noise::{self, stream};
use crate::state::State;

/// Random places of which each particle takes the one that is farthest from all before it.
const CANDIDATES: u32 = 16;

/// Appends the positions of a group: a half behind each wall where it names none, the odd one behind the lower.
///
/// Random places leave clusters and holes, which a fluid feels as a rough wall, and a lattice makes the fluid before it form one. The best of
/// some random candidates is in no order, and about as even as a fluid. Distances to the own layer are taken as if it were periodic across
/// itself too, which keeps its density the same at every depth.
pub(crate) fn place(state: &mut State, placement: &Placement, count: usize, model: &Model) {
    let Placement::BehindWalls { axis, wall, thickness } = *placement else { return };
    let lower = match wall {
        Some(WallSide::Lower) => count,
        Some(WallSide::Upper) => 0,
        None => count.div_ceil(2),
    };
    for (upper, number) in [(false, lower), (true, count - lower)] {
        Layer::new(model, axis as usize, thickness, number).fill(state, number, upper, model);
    }
}

/// The momenta that particles at their places behind walls keep, of a mass.
pub(crate) fn momenta(places: &[[u32; 3]], mass: f64, model: &Model) -> Vec<[i32; 3]> {
    let (walls, ends) = (&model.particles().walls, model.units.ends());
    let carried = |place: &[u32; 3]| match PlaneWalls::behind(walls, ends, *place) {
        Some((pair, upper)) => walls[pair].carried(upper, mass, model),
        None => [0; 3],
    };
    places.iter().map(carried).collect()
}

/// The particles of a layer that have been placed, by cells.
struct Layer {
    across: usize,
    dimension: usize,
    lengths: [f64; 3],
    /// Whether distances go round an axis.
    periodic: [bool; 3],
    cells: [usize; 3],
    /// About the distance of neighbours, and the least edge of a cell.
    spacing: f64,
    members: Vec<Vec<[f64; 3]>>,
}

impl Layer {
    fn new(model: &Model, across: usize, thickness: f64, number: usize) -> Self {
        let dimension = model.units.dimension;
        let mut lengths = model.units.edges();
        lengths[across] = thickness;
        let periodic = std::array::from_fn(|axis| axis == across || model.units.gaps[axis] == 0.0);
        let volume: f64 = lengths[..dimension].iter().product();
        let spacing = (volume / number.max(1) as f64).powf(1.0 / dimension as f64);
        let cells: [usize; 3] = std::array::from_fn(|axis| {
            if axis < dimension { ((lengths[axis] / spacing) as usize).clamp(1, number.max(1)) } else { 1 }
        });
        let members = vec![Vec::new(); cells.iter().product()];
        Self { across, dimension, lengths, periodic, cells, spacing, members }
    }

    fn fill(&mut self, state: &mut State, number: usize, upper: bool, model: &Model) {
        let first = state.len();
        for id in first..first + number {
            let mut best = (f64::NEG_INFINITY, [0.0; 3]);
            for candidate in 0..CANDIDATES {
                let place = self.random_place(id, candidate, model);
                let clearance = self.clearance(place);
                if clearance > best.0 {
                    best = (clearance, place);
                }
            }
            let index = self.index(self.cell_of(best.1));
            self.members[index].push(best.1);
            state.positions.push(self.behind(best.1, upper, model));
        }
    }

    fn random_place(&self, id: usize, candidate: u32, model: &Model) -> [f64; 3] {
        let key = noise::step_key(model.seed, stream::POSITION, 0);
        let words = |counter: u32| noise::words(Generator::Threefry2x32, key, [id as u32, counter]);
        let ([x, y], [z, _]) = (words(2 * candidate), words(2 * candidate + 1));
        let fractions = [x, y, z].map(|word| f64::from(word) / 4_294_967_296.0);
        std::array::from_fn(|axis| if axis < self.dimension { fractions[axis] * self.lengths[axis] } else { 0.0 })
    }

    fn cell_of(&self, place: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| {
            let cell = (place[axis] / self.lengths[axis] * self.cells[axis] as f64) as usize;
            cell.min(self.cells[axis] - 1)
        })
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// The squared distance of the nearest particle so far, at most that of a spacing.
    fn clearance(&self, place: [f64; 3]) -> f64 {
        let middle = self.cell_of(place);
        let around = |axis: usize| {
            let (cells, cell, round) = (self.cells[axis] as isize, middle[axis] as isize, self.periodic[axis]);
            (cell - 1..=cell + 1)
                .filter(move |near| round || (0..cells).contains(near))
                .map(move |near| near.rem_euclid(cells) as usize)
        };
        let mut least = self.spacing * self.spacing;
        for z in around(2) {
            for y in around(1) {
                for x in around(0) {
                    for other in &self.members[self.index([x, y, z])] {
                        least = least.min(self.squared_distance(place, *other));
                    }
                }
            }
        }
        least
    }

    fn squared_distance(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        let apart = |axis: usize| {
            let straight = (a[axis] - b[axis]).abs();
            if self.periodic[axis] { straight.min(self.lengths[axis] - straight) } else { straight }
        };
        (0..self.dimension).map(|axis| apart(axis).powi(2)).sum()
    }

    /// The integer place behind a wall: as many places behind the lower one as behind the upper one at the same depth.
    fn behind(&self, place: [f64; 3], upper: bool, model: &Model) -> [u32; 3] {
        let (units, ends) = (model.units, model.units.ends());
        let mut behind = units.place(place);
        let depth = (place[self.across] / units.lengths[self.across] * 4_294_967_296.0) as u32;
        behind[self.across] = if upper { ends[self.across] + depth } else { u32::MAX - depth };
        behind
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::families::Checked;

    use crate::families::initial_state;
    use serde_json::{Value, json};

    fn start(seed: u64, walls: &Value, placement: &Value) -> (Model, State) {
        let scene = serde_json::from_value(json!({
            "title": "test", "seed": seed, "space": {"box": [9.0, 8.0, 7.0], "walls": walls},
            "time": {"step": 0.1, "steps": 1}, "temperature": 1.0, "interactions": [{"type": "dpd"}],
            "particles": [{"species": "A", "count": 10},
                {"species": "W", "number_density": 3.0, "mass": 2.0, "placement": placement}],
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        (scene.model().clone(), initial_state(&scene))
    }

    /// Heights above the lower wall of the frozen particles.
    fn heights(model: &Model, state: &State) -> Vec<f64> {
        state.positions[10..].iter().map(|position| model.units.position(*position)[2]).collect()
    }

    #[test]
    fn half_of_a_layer_is_behind_each_wall() {
        let walls = json!({"x": {}, "z": {"lower_velocity": [0, 1.5, 0], "upper_velocity": [0, -0.5, 0]}});
        let (model, state) = start(1, &walls, &json!({"type": "behind-walls", "axis": "z", "thickness": 1.1}));
        let heights = heights(&model, &state);
        assert_eq!(heights.len(), (3.0 * 2.0 * 1.1 * 9.0 * 8.0_f64).round() as usize);
        let lower = heights.iter().filter(|height| (-1.1..0.0).contains(*height)).count();
        let upper = heights.iter().filter(|height| (7.0..8.1).contains(*height)).count();
        assert_eq!([lower, upper], [heights.len().div_ceil(2), heights.len() / 2]);
        for (id, height) in heights.iter().enumerate() {
            let [x, y, _] = model.units.position(state.positions[10 + id]);
            assert!((0.0..9.0).contains(&x) && (0.0..8.0).contains(&y), "{x} {y}");
            let momentum = model.units.momentum(state.momenta[10 + id]);
            assert_eq!(momentum, [0.0, if *height < 0.0 { 3.0 } else { -1.0 }, 0.0]);
        }
        // Both layers and the space between them, over which nothing acts.
        let gap = model.units.gaps[2];
        assert!(gap > 2.0 * 1.1 + 1.0 && gap < 2.0 * 1.1 + 1.01, "{gap}");
        // Particles between the walls start at rest together, whatever those behind them do.
        let moving = state.momenta[..10].iter().fold([0; 3], |sum, p| std::array::from_fn(|axis| sum[axis] + p[axis]));
        assert_eq!(moving, [0; 3]);
    }

    #[test]
    fn one_wall_alone_has_a_layer() {
        for (wall, low, high) in [("lower", -2.0, 0.0), ("upper", 7.0, 9.0)] {
            let placement = json!({"type": "behind-walls", "axis": "z", "wall": wall, "thickness": 2});
            let (model, state) = start(1, &json!({"z": {}}), &placement);
            let heights = heights(&model, &state);
            assert_eq!(heights.len(), 432);
            assert!(heights.iter().all(|height| (low..high).contains(height)), "{wall}");
        }
    }

    /// As dense at every depth, and nobody as close to a neighbour as random places are: of 648 there would be 5 pairs within .12.
    #[test]
    fn layers_are_even() {
        for seed in 1..=3 {
            let placement = json!({"type": "behind-walls", "axis": "z", "wall": "upper", "thickness": 3});
            let (model, state) = start(seed, &json!({"z": {}}), &placement);
            let heights = heights(&model, &state);
            for depth in 0..6 {
                let low = 7.0 + 0.5 * f64::from(depth);
                let found = heights.iter().filter(|height| (low..low + 0.5).contains(*height)).count();
                // 108 each, of which chance among neighbours of .7 leaves fewer than the root off.
                assert!((85..=131).contains(&found), "{found} in depth {depth}");
            }
            let frozen = &state.positions[10..];
            let distance = |(a, b): (usize, usize)| {
                model.units.displacement(frozen[a], frozen[b]).iter().map(|part| part * part).sum::<f64>().sqrt()
            };
            let pairs = (0..frozen.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
            let nearest = pairs.map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest > 0.3, "{nearest}");
        }
        let positions = |seed: u64| {
            let placement = json!({"type": "behind-walls", "axis": "z", "thickness": 1});
            start(seed, &json!({"z": {}}), &placement).1.positions
        };
        assert_eq!(positions(4), positions(4));
        assert_ne!(positions(4)[10..], positions(5)[10..]);
    }
}
