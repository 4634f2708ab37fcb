//! Coloured noise in float64: its impulse over half a step is exact, wherever the jumps are.

use super::ColouredNoise;
use crate::families::Model;
use crate::families::particles::reference::{Kicks, Moment, held, round};
use crate::families::particles::terms::ReferenceTerm;
use crate::state::Hold;

impl ReferenceTerm for ColouredNoise {
    /// Impulses ∫F dt over the half step before the moment, if there is one, and over the half step after it, to
    /// whose end the forces of all particles advance.
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        let (model, state) = (moment.model, moment.state);
        let (mut closing, mut opening) = (vec![[0; 3]; state.len()], vec![[0; 3]; state.len()]);
        let mut holds = state.holds.clone();
        for (particle, hold) in holds.iter_mut().enumerate() {
            if model.clock(state.step) > 0 {
                round(&mut closing[particle], half_step(model, self, particle as u32, hold), model.units.momentum);
            }
            round(&mut opening[particle], half_step(model, self, particle as u32, hold), model.units.momentum);
        }
        held::exclude(model, state, &mut closing);
        held::exclude(model, state, &mut opening);
        (kicks.closing, kicks.opening, kicks.baths.holds) = (closing, opening, holds);
    }
}

/// ∫F dt over half a step, in which the process is taken along.
fn half_step(model: &Model, noise: &ColouredNoise, id: u32, hold: &mut Hold) -> [f64; 3] {
    let duration = 0.5 * model.time_step;
    let mut impulse = [0.0; 3];
    // The rest of the half step, and that of the force, in half steps.
    let mut rest = 1.0_f64;
    let mut left = f64::from(hold.halves) + f64::from(f32::from_bits(hold.fraction));
    loop {
        let spent = rest.min(left);
        for axis in 0..3 {
            impulse[axis] += spent * duration * f64::from(f32::from_bits(hold.force[axis]));
        }
        rest -= spent;
        left -= spent;
        if left > 0.0 {
            let force = hold.force.map(|bits| f64::from(f32::from_bits(bits)));
            *hold = ColouredNoise::hold(force, left, hold.jump);
            return impulse;
        }
        let jump = noise.jump(model.units.dimension, ColouredNoise::uniform_numbers(model, id, hold.jump));
        *hold = ColouredNoise::hold(jump.force, jump.time / duration, hold.jump.wrapping_add(1));
        left = f64::from(hold.halves) + f64::from(f32::from_bits(hold.fraction));
    }
}
