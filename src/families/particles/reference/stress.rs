//! The virials r f of what acts between particles, as tensors, at the report point.

use super::held;
use super::pairs::Pair;
use crate::families::Model;
use crate::state::State;

/// The share of a particle of the virials at a report, as symmetric tensors xx, yy, zz, xy, xz, yz: half of every pair and bond, and all
/// of the angles whose vertex it is. Forces of a split step are those of the whole step, two half kicks and the relaxation between them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Virial {
    /// Of conservative forces.
    pub conservative: [f64; 6],
    /// Of friction, noise and baths.
    pub frictional: [f64; 6],
}

/// The axes of each component.
pub(crate) const AXES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// The virials of all particles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Virials {
    /// Σ r·F of everything.
    pub total: f64,
    /// Of each particle.
    pub each: Vec<Virial>,
    /// Of the waves of charges, which belong to no particle: as the conservative ones of particles.
    pub of_waves: [f64; 6],
    /// The part of its share of every pair by which each particle counts in the total: none of what is held.
    counts: Vec<f64>,
}

impl Virials {
    pub(crate) fn new(model: &Model, state: &State) -> Self {
        let counts = |particle: usize| if held::is_held(model, state, particle) { 0.0 } else { 1.0 };
        Self {
            total: 0.0,
            each: vec![Virial::default(); state.len()],
            of_waves: [0.0; 6],
            counts: (0..state.len()).map(counts).collect(),
        }
    }

    /// Adds the forces of a pair or a bond along the line of centres, positive apart.
    pub(crate) fn add(&mut self, pair: &Pair, conservative: f64, frictional: f64) {
        let counts = 0.5 * (self.counts[pair.first] + self.counts[pair.second]);
        self.total += counts * pair.distance * (conservative + frictional);
        let direction = pair.direction();
        for end in [pair.first, pair.second] {
            let virial = &mut self.each[end];
            for (component, [a, b]) in AXES.into_iter().enumerate() {
                let share = 0.5 * pair.distance * direction[a] * direction[b];
                virial.conservative[component] += share * conservative;
                virial.frictional[component] += share * frictional;
            }
        }
    }

    /// Adds the conservative force on the end of an arm from the vertex of an angle.
    pub(crate) fn add_arm(&mut self, vertex: usize, arm: [f64; 3], force: [f64; 3]) {
        for (component, [a, b]) in AXES.into_iter().enumerate() {
            // Both arms together are symmetric.
            self.each[vertex].conservative[component] += 0.5 * (arm[a] * force[b] + arm[b] * force[a]);
        }
    }
}
