//! The end of a step of particles: the opening kick, what friction will see of it, and the drift.

use super::held;
use crate::document::Integrator;
use crate::families::Model;
use crate::families::particles::space::shear::reference as shear;
use crate::families::particles::space::walls::reference::{self as walls, Flight, Way};
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
    let absorbed = held::absorbed(model, state, &momenta);
    held::hold(model, state, &mut momenta);
    let advanced = narrow(&momenta, state.step)?;
    let mut turned = move_on(model, masses, state, &advanced, parts, parts)?;
    if !absorbed.is_empty() {
        state.walls = walls::add(&state.walls, &absorbed);
    }
    // Friction sees none of the impulses on held particles.
    held::exclude(model, state, &mut turned);
    state.predicted = match model.particles().integrator {
        Integrator::GrootWarren { lambda } if lambda != 0.5 => {
            let turn = |(kick, turned): (&[i64; 3], &[i64; 3])| std::array::from_fn(|axis| kick[axis] * turned[axis]);
            let opening: Vec<[i64; 3]> = opening.iter().zip(&turned).map(turn).collect();
            prediction::predicted(&state.momenta, &opening, lambda)
        }
        _ => Vec::new(),
    };
    state.step = state.step.wrapping_add(1);
    Ok(())
}

/// Gives particles momenta and moves them by some of the equal parts of a step. Gives what walls have made of a unit of momentum.
///
/// # Errors
/// [`Unstable`] as [`end`].
pub(super) fn move_on(
    model: &Model,
    masses: &[f64],
    state: &mut State,
    momenta: &[[i32; 3]],
    parts: i64,
    of_parts: i64,
) -> Result<Vec<[i64; 3]>, Unstable> {
    let whole = drifts(model, masses, momenta, of_parts);
    let ways: Vec<[i64; 3]> = whole.iter().map(|way| way.map(|units| units / of_parts * parts)).collect();
    if let Some(shear) = &model.particles().shear {
        shear::move_on((model, shear), masses, state, momenta, parts, of_parts)?;
        return Ok(vec![[1; 3]; state.len()]);
    }
    if model.particles().walls.is_empty() {
        drift(state, &ways)?;
        state.momenta = momenta.to_vec();
        return Ok(vec![[1; 3]; state.len()]);
    }
    // What is too far is so between walls too.
    drift(&mut state.clone(), &ways)?;
    let mut taken = vec![[0; 3]; 2 * model.particles().walls.len()];
    let fly = |(particle, momentum): (usize, &[i32; 3])| {
        let way = Way { species: state.species[particle], parts: of_parts, back: false };
        let start = Flight { place: state.positions[particle], momentum: momentum.map(i64::from), turned: [1; 3] };
        (0..parts).fold(start, |flight, _| walls::fly(model, flight, way, &mut taken))
    };
    let flights: Vec<Flight> = momenta.iter().enumerate().map(fly).collect();
    let reflected: Vec<[i64; 3]> = flights.iter().map(|flight| flight.momentum).collect();
    state.momenta = narrow(&reflected, state.step)?;
    state.positions = flights.iter().map(|flight| flight.place).collect();
    state.walls = walls::add(&state.walls, &taken);
    Ok(flights.iter().map(|flight| flight.turned).collect())
}

/// dt p/m of all particles, in whole units of the box fraction, each of the equal parts rounded half to even.
pub(crate) fn drifts(model: &Model, masses: &[f64], momenta: &[[i32; 3]], parts: i64) -> Vec<[i64; 3]> {
    let drift = |(momentum, mass): (&[i32; 3], &f64)| {
        let momentum = model.units.momentum(*momentum);
        std::array::from_fn(|axis| {
            let distance = model.time_step * momentum[axis] / mass / parts as f64;
            parts * whole_fractions(distance, model.units.lengths[axis])
        })
    };
    momenta.iter().zip(masses).map(drift).collect()
}
