//! A random force that is constant between jumps: its impulse over half a step is exact, wherever the jumps are.

use super::push;
use crate::families::{ColouredNoise, Model};
use crate::state::{Hold, State};

/// Impulses of a step, and the forces after it.
pub(in crate::families::particles::reference) struct Held {
    /// ∫F dt over [t(n) - dt/2, t(n)], rounded; none at step 0.
    pub closing: Vec<[i64; 3]>,
    /// ∫F dt over [t(n), t(n) + dt/2], rounded.
    pub opening: Vec<[i64; 3]>,
    /// The process at t(n) + dt/2.
    pub holds: Vec<Hold>,
}

/// Advances the forces of all particles to half a step after the current one.
pub(in crate::families::particles::reference) fn advance(model: &Model, noise: &ColouredNoise, state: &State) -> Held {
    let count = state.len();
    let mut held = Held { closing: vec![[0; 3]; count], opening: vec![[0; 3]; count], holds: state.holds.clone() };
    for (particle, hold) in held.holds.iter_mut().enumerate() {
        if model.clock(state.step) > 0 {
            push(&mut held.closing[particle], half_step(model, noise, particle as u32, hold), model.units.momentum);
        }
        push(&mut held.opening[particle], half_step(model, noise, particle as u32, hold), model.units.momentum);
    }
    held
}

/// ∫F dt over half a step, in which the process is taken along.
fn half_step(model: &Model, noise: &ColouredNoise, id: u32, hold: &mut Hold) -> [f64; 3] {
    let duration = 0.5 * model.time_step;
    let mut impulse = [0.0; 3];
    // What is left of the half step, and of the force, in half steps.
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
