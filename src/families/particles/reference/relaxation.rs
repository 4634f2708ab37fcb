//! The part of O that is exact, whatever the friction and the step: the relaxation of single particles, on momenta that are
//! rounded to whole units once.

use crate::families::Model;
use crate::noise::{self, stream};
use crate::state::State;

/// Friction and noise of every particle by itself: each component of its momentum is an Ornstein-Uhlenbeck process,
/// p' = c p + √(mkT(1 - c²)) ξ with c = exp(-γdt/m).
pub(super) fn of_particles(model: &Model, state: &State, masses: &[f64], momenta: &mut [[i64; 3]]) {
    let Some(bath) = model.particles().position_bath.as_ref().filter(|bath| !bath.memory) else { return };
    let key = noise::step_key(model.seed, stream::PARTICLE, state.step);
    for (particle, momentum) in momenta.iter_mut().enumerate() {
        let mass = masses[particle];
        let friction = 0.5 * model.time_step * bath.steps[state.species[particle] as usize].coupling;
        let kept = (-friction * model.time_step / mass).exp();
        let deviation = (mass * bath.temperature * (1.0 - kept * kept)).sqrt() / model.units.momentum;
        for (axis, component) in momentum.iter_mut().enumerate().take(model.units.dimension) {
            let gaussian = noise::gaussian(noise::words(model.generator, key, [particle as u32, axis as u32]));
            *component = (kept * *component as f64 + deviation * gaussian).round_ties_even() as i64;
        }
    }
}
