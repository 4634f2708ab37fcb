//! What brought the particles where they are: the change of a coupling function h over the last drift.

use super::end_of_step;
use super::pairs::{Pair, dot};
use crate::document::Integrator;
use crate::families::Model;
use crate::state::State;

/// The last drift of every particle, and the velocities that friction may see in its place.
pub(super) struct Motion {
    /// r(n) - r(n-1).
    drifts: Vec<[f64; 3]>,
    /// The velocities that white baths see, where they see velocities.
    velocities: Option<Vec<[f64; 3]>>,
    /// By how much a velocity along x is larger one box up, where boundaries shear.
    jump: f64,
    time_step: f64,
}

impl Motion {
    /// The drifts that the momenta in the state have made; at step 0 they are taken to have made one.
    pub fn of(model: &Model, state: &State, masses: &[f64]) -> Self {
        let length = |axis: usize| model.units.lengths[axis] / 4_294_967_296.0;
        let drifts = end_of_step::drifts(model, masses, &state.momenta, 1);
        let seen = if state.predicted.is_empty() { &state.momenta } else { &state.predicted };
        let velocity = |(momentum, mass): (&[i32; 3], &f64)| model.units.momentum(*momentum).map(|p| p / mass);
        Self {
            drifts: drifts.iter().map(|d| std::array::from_fn(|axis| d[axis] as f64 * length(axis))).collect(),
            velocities: matches!(model.integrator, Integrator::GrootWarren { .. })
                .then(|| seen.iter().zip(masses).map(velocity).collect()),
            jump: model.particles().shear.as_ref().map_or(0.0, |shear| shear.velocity),
            time_step: model.time_step,
        }
    }

    /// The drift of a particle.
    pub fn drift(&self, particle: usize) -> [f64; 3] {
        self.drifts[particle]
    }

    /// What a bath without memory takes for the drift of a particle.
    pub fn drift_seen(&self, particle: usize) -> [f64; 3] {
        match &self.velocities {
            Some(velocities) => velocities[particle].map(|velocity| velocity * self.time_step),
            None => self.drifts[particle],
        }
    }

    /// The separation of a pair before the last drift.
    fn separation_before(&self, pair: &Pair) -> [f64; 3] {
        let (first, second) = (self.drifts[pair.first], self.drifts[pair.second]);
        std::array::from_fn(|axis| pair.separation[axis] - (first[axis] - second[axis]))
    }

    /// The distance of a pair before the last drift.
    pub fn distance_before(&self, pair: &Pair) -> f64 {
        let before = self.separation_before(pair);
        dot(before, before).sqrt()
    }

    /// By how much the distance of a pair has changed over the last drift: (d² - d'²)/(d + d'), without cancellation.
    pub fn change_of_distance(&self, pair: &Pair) -> f64 {
        let (now, before) = (pair.separation, self.separation_before(pair));
        let sum = std::array::from_fn(|axis| now[axis] + before[axis]);
        let difference = std::array::from_fn(|axis| now[axis] - before[axis]);
        let lengths = pair.distance + dot(before, before).sqrt();
        if lengths == 0.0 { 0.0 } else { dot(sum, difference) / lengths }
    }

    /// dt e·(vᵢ - vⱼ), where baths without memory see velocities.
    pub fn approach(&self, pair: &Pair) -> Option<f64> {
        let velocities = self.velocities.as_ref()?;
        let (first, second) = (velocities[pair.first], velocities[pair.second]);
        let mut relative: [f64; 3] = std::array::from_fn(|axis| first[axis] - second[axis]);
        relative[0] -= pair.boxes_up as f64 * self.jump;
        Some(self.time_step * dot(pair.direction(), relative))
    }
}
