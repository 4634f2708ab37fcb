//! Langevin dynamics in float64.

use super::PositionBath;
use crate::families::Model;
use crate::families::particles::reference::{Kicks, Moment};
use crate::families::particles::space::shear::reference as shear;
use crate::families::particles::terms::ReferenceTerm;
use crate::families::reference::bath;
use crate::noise::{self, stream};
use crate::state::State;

impl ReferenceTerm for PositionBath {
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        // In split steps baths without memory relax momenta.
        if moment.model.particles().relaxes_particles() {
            return;
        }
        let (model, state, motion) = (moment.model, moment.state, &moment.motion);
        let key = noise::step_key(model.seed, stream::PARTICLE, model.clock(state.step));
        let mut baths = state.position_baths.clone();
        for particle in 0..state.len() {
            let step = &self.steps[state.species[particle] as usize];
            let mut drift = if self.memory { motion.way(particle) } else { motion.drift_seen(particle) };
            if let Some(shear) = model.particles().shear.as_ref().filter(|_| self.peculiar) {
                let height = f64::from(state.positions[particle][shear.gradient]) / 4_294_967_296.0 - 0.5;
                drift[0] -= height * shear.velocity * model.time_step;
            }
            let mut impulse = [0.0; 3];
            for axis in 0..model.units.dimension {
                let gaussian = noise::gaussian(noise::words(model.generator, key, [particle as u32, axis as u32]));
                let kept = baths.get_mut(particle).map(|bath| &mut bath[axis]);
                let value =
                    bath::at_report(step, self.temperature, model.clock(state.step), kept, drift[axis], gaussian);
                kicks.bath_sums.add(step, value);
                impulse[axis] = -0.5 * model.time_step * value;
            }
            kicks.push(model, particle, impulse);
        }
        kicks.baths.position_baths = baths;
    }
}

/// Friction and noise in the O of a split step, on momenta that are rounded to whole units once: each component of a
/// momentum is an Ornstein-Uhlenbeck process, p' = c p + √(mkT(1 - c²)) ξ with c = exp(-γdt/m).
pub(crate) fn relax(model: &Model, state: &State, masses: &[f64], momenta: &mut [[i64; 3]]) {
    let Some(bath) = model.particles().position_bath.as_ref().filter(|bath| !bath.memory) else { return };
    let key = noise::step_key(model.seed, stream::PARTICLE, model.clock(state.step));
    for (particle, momentum) in momenta.iter_mut().enumerate() {
        let mass = masses[particle];
        let friction = 0.5 * model.time_step * bath.steps[state.species[particle] as usize].coupling;
        let kept = (-friction * model.time_step / mass).exp();
        let deviation = (mass * bath.temperature * (1.0 - kept * kept)).sqrt() / model.units.momentum;
        let flow = if bath.peculiar { shear::flow(model, state, particle) } else { 0.0 };
        for (axis, component) in momentum.iter_mut().enumerate().take(model.units.dimension) {
            let gaussian = noise::gaussian(noise::words(model.generator, key, [particle as u32, axis as u32]));
            let at_rest = if axis == 0 { flow } else { 0.0 };
            *component =
                (at_rest + kept * (*component as f64 - at_rest) + deviation * gaussian).round_ties_even() as i64;
        }
    }
}
