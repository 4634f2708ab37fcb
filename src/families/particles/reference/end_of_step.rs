//! The end of a step of particles: the opening kick, what friction will see of it, and the drift.

use crate::document::Integrator;
use crate::families::Model;
use crate::families::reference::{Unstable, add, drift, narrow, whole_fractions};
use crate::prediction;
use crate::state::State;

/// Takes a state from its report point, where momenta are p(n), to the next step. A step may drift in two equal halves, between
/// which a report may fall: `parts` is then 2.
///
/// # Errors
/// [`Unstable`] when a momentum or a drift does not fit the integer state, which is then left as it was.
pub(super) fn end(
    model: &Model,
    masses: &[f64],
    state: &mut State,
    mut momenta: Vec<[i64; 3]>,
    opening: &[[i64; 3]],
    parts: i64,
) -> Result<(), Unstable> {
    add(&mut momenta, opening);
    let advanced = narrow(&momenta, state.step)?;
    let drifts = drifts(model, masses, &advanced, parts);
    drift(state, &drifts)?;
    state.predicted = match model.integrator {
        Integrator::GrootWarren { lambda } if lambda != 0.5 => prediction::predicted(&advanced, opening, lambda),
        _ => Vec::new(),
    };
    state.momenta = advanced;
    state.step = state.step.wrapping_add(1);
    Ok(())
}

/// dt p/m of all particles, in whole units of the box fraction, each of the equal parts rounded half to even.
pub(super) fn drifts(model: &Model, masses: &[f64], momenta: &[[i32; 3]], parts: i64) -> Vec<[i64; 3]> {
    let drift = |(momentum, mass): (&[i32; 3], &f64)| {
        let momentum = model.units.momentum(*momentum);
        std::array::from_fn(|axis| {
            let distance = model.time_step * momentum[axis] / mass / parts as f64;
            parts * whole_fractions(distance, model.units.lengths[axis])
        })
    };
    momenta.iter().zip(masses).map(drift).collect()
}
