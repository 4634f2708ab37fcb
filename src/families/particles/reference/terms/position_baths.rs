//! Langevin dynamics: a bath coupled to every coordinate of every particle by itself, h = x.

use super::push;
use crate::families::particles::reference::motion::Motion;
use crate::families::reference::bath::{self, BathSums};
use crate::families::{Model, PositionBath};
use crate::noise::{self, stream};
use crate::state::State;

/// Adds the half kicks of all baths and gives their variables, where they remember.
pub(in crate::families::particles::reference) fn kick(
    model: &Model,
    bath: &PositionBath,
    state: &State,
    motion: &Motion,
    kick: &mut [[i64; 3]],
    bath_sums: &mut BathSums,
) -> Vec<[u32; 3]> {
    let key = noise::step_key(model.seed, stream::PARTICLE, model.clock(state.step));
    let mut baths = state.position_baths.clone();
    for (particle, sum) in kick.iter_mut().enumerate() {
        let step = &bath.steps[state.species[particle] as usize];
        let mut drift = if bath.memory { motion.way(particle) } else { motion.drift_seen(particle) };
        if let Some(shear) = model.particles().shear.as_ref().filter(|_| bath.peculiar) {
            let height = f64::from(state.positions[particle][shear.gradient]) / 4_294_967_296.0 - 0.5;
            drift[0] -= height * shear.velocity * model.time_step;
        }
        let mut impulse = [0.0; 3];
        for axis in 0..model.units.dimension {
            let gaussian = noise::gaussian(noise::words(model.generator, key, [particle as u32, axis as u32]));
            let kept = baths.get_mut(particle).map(|bath| &mut bath[axis]);
            let value = bath::at_report(step, bath.temperature, model.clock(state.step), kept, drift[axis], gaussian);
            bath_sums.add(step, value);
            impulse[axis] = -0.5 * model.time_step * value;
        }
        push(sum, impulse, model.units.momentum);
    }
    baths
}
