//! What brought the particles where they are: the change of a coupling function h over the last drift.

use super::end_of_step;
use super::pairs::{Pair, dot};
use crate::document::Integrator;
use crate::families::Model;
use crate::families::particles::space::walls::reference as walls;
use crate::state::State;

/// The last drift of every particle, and the velocities that friction may see in its place.
pub(crate) struct Motion {
    /// dt p/m: r(n) - r(n-1), where no wall has reflected it.
    drifts: Vec<[f64; 3]>,
    /// r(n) - r(n-1) between walls.
    ways: Option<Vec<[f64; 3]>>,
    /// The velocities that white baths see, where they see velocities.
    velocities: Option<Vec<[f64; 3]>>,
    /// By how much a velocity along x is larger one box up, where boundaries shear.
    jump: f64,
    time_step: f64,
}

impl Motion {
    /// The drifts that the momenta in the state have made; at step 0 they are taken to have made one.
    pub(crate) fn of(model: &Model, state: &State, masses: &[f64]) -> Self {
        let length = |axis: usize| model.units.lengths[axis] / 4_294_967_296.0;
        let drifts = end_of_step::drifts(model, masses, &state.momenta, 1);
        let seen = if state.predicted.is_empty() { &state.momenta } else { &state.predicted };
        let way = |particle: usize| -> [f64; 3] {
            let [end, start] = [state.positions[particle], walls::before(model, state, particle, 1).place];
            std::array::from_fn(|axis| f64::from(end[axis].wrapping_sub(start[axis]).cast_signed()) * length(axis))
        };
        let velocity = |(momentum, mass): (&[i32; 3], &f64)| model.units.momentum(*momentum).map(|p| p / mass);
        Self {
            drifts: drifts.iter().map(|d| std::array::from_fn(|axis| d[axis] as f64 * length(axis))).collect(),
            ways: (!model.particles().walls.is_empty()).then(|| (0..state.len()).map(way).collect()),
            velocities: matches!(model.particles().integrator, Integrator::GrootWarren { .. })
                .then(|| seen.iter().zip(masses).map(velocity).collect()),
            jump: model.particles().shear.as_ref().map_or(0.0, |shear| shear.velocity),
            time_step: model.time_step,
        }
    }

    /// The way of a particle in the last step, which a bath with memory sees.
    pub(crate) fn way(&self, particle: usize) -> [f64; 3] {
        self.ways.as_ref().unwrap_or(&self.drifts)[particle]
    }

    /// What a bath without memory takes for the drift of a particle.
    pub(crate) fn drift_seen(&self, particle: usize) -> [f64; 3] {
        match &self.velocities {
            Some(velocities) => velocities[particle].map(|velocity| velocity * self.time_step),
            None => self.drifts[particle],
        }
    }

    /// The separation of a pair before its ends have moved, and with it the image of the second across a boundary.
    fn separation_before(&self, pair: &Pair, moved: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
        let (first, second) = (moved(pair.first), moved(pair.second));
        let mut before: [f64; 3] = std::array::from_fn(|axis| pair.separation[axis] - (first[axis] - second[axis]));
        before[0] += pair.boxes_up as f64 * self.jump * self.time_step;
        before
    }

    /// The distance of a pair before the last drift.
    pub(crate) fn distance_before(&self, pair: &Pair) -> f64 {
        let before = self.separation_before(pair, |particle| self.drifts[particle]);
        dot(before, before).sqrt()
    }

    /// By how much the distance of a pair has changed over the last drift, as a bath without memory sees it.
    pub(crate) fn drift_of_distance(&self, pair: &Pair) -> f64 {
        Self::change(pair, self.separation_before(pair, |particle| self.drifts[particle]))
    }

    /// By how much the distance of a pair has changed in the last step, as a bath with memory sees it.
    pub(crate) fn change_of_distance(&self, pair: &Pair) -> f64 {
        Self::change(pair, self.separation_before(pair, |particle| self.way(particle)))
    }

    /// By how much the distance of a pair has changed since a separation: (d² - d'²)/(d + d'), without cancellation.
    fn change(pair: &Pair, before: [f64; 3]) -> f64 {
        let now = pair.separation;
        let sum = std::array::from_fn(|axis| now[axis] + before[axis]);
        let difference = std::array::from_fn(|axis| now[axis] - before[axis]);
        let lengths = pair.distance + dot(before, before).sqrt();
        if lengths == 0.0 { 0.0 } else { dot(sum, difference) / lengths }
    }

    /// dt e·(vᵢ - vⱼ), where baths without memory see velocities.
    pub(crate) fn approach(&self, pair: &Pair) -> Option<f64> {
        let velocities = self.velocities.as_ref()?;
        let (first, second) = (velocities[pair.first], velocities[pair.second]);
        let mut relative: [f64; 3] = std::array::from_fn(|axis| first[axis] - second[axis]);
        relative[0] -= pair.boxes_up as f64 * self.jump;
        Some(self.time_step * dot(pair.direction(), relative))
    }
}
