//! Body forces: their impulses of half a step, and what they give.
//!
//! The closing and the opening impulse of a step are those of its places. The work over a drift from r(n) to r(n+1) is
//! (k(n) + k(n+1)) v(n+½) with the impulses k of half a step at both ends: force times displacement. Where walls reflect a particle in
//! between, each impulse goes with the velocity at its end.

use super::{BodyForces, FixedImpulse};
use crate::document::ForceProfile;
use crate::families::particles::plan::quanta::quanta;
use crate::families::particles::reference::{Kicks, Moment, end_of_step};
use crate::families::particles::space::walls::reference as walls;
use crate::families::particles::terms::ReferenceTerm;
use crate::families::reference::add;
use crate::families::{Model, Transfer};
use crate::state::{Account, State};
use std::f64::consts::TAU;

/// The impulse on a particle of a species at a place in a step, in whole units.
fn impulse(model: &Model, forces: &BodyForces, species: u32, place: [u32; 3], step: u64) -> [i64; 3] {
    let full = forces.impulse(model, species as usize);
    let turns = f64::from(place[forces.axis]) / 4_294_967_296.0;
    let part = match forces.profile {
        // A whole number of parts of a turn a step.
        ForceProfile::Uniform => forces.turn.map_or(1.0, |turn| {
            let angle = (step as u32).wrapping_mul(turn);
            (TAU * f64::from(angle) / 4_294_967_296.0).cos()
        }),
        ForceProfile::Opposed => {
            if turns < 0.5 {
                1.0
            } else {
                -1.0
            }
        }
        ForceProfile::Sinusoidal => (TAU * (turns * f64::from(forces.waves)).fract()).sin(),
    };
    full.map(|FixedImpulse(full)| {
        let size = if part.abs() == 1.0 { full } else { (full as f64 * part.abs()).round() as i64 };
        let whole = FixedImpulse(size).in_step(step);
        if part < 0.0 { -whole } else { whole }
    })
}

/// The impulses of all particles in the step of a state.
fn impulses(model: &Model, forces: &BodyForces, state: &State) -> Vec<[i64; 3]> {
    let particles = state.species.iter().zip(&state.positions);
    let step = model.clock(state.step);
    particles.map(|(species, place)| impulse(model, forces, *species, *place, step)).collect()
}

impl ReferenceTerm for BodyForces {
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        add(&mut kicks.both, &impulses(moment.model, self, moment.state));
    }
}

/// The work over the drift that has brought the particles where they are.
fn work(model: &Model, forces: &BodyForces, state: &State, masses: &[f64], impulses: &[[i64; 3]]) -> f64 {
    if model.clock(state.step) == 0 {
        return 0.0;
    }
    let parts = if model.particles().splits() { 2 } else { 1 };
    let drifts = end_of_step::drifts(model, masses, &state.momenta, parts);
    let mut work = 0.0;
    for (particle, drift) in drifts.iter().enumerate() {
        let now = state.positions[particle];
        let momentum = state.momenta[particle].map(i64::from);
        let (before, first_momentum) = if model.particles().walls.is_empty() {
            (std::array::from_fn(|axis| now[axis].wrapping_sub(drift[axis] as u32)), momentum)
        } else {
            let start = walls::before(model, state, particle, parts);
            (start.place, start.momentum)
        };
        let first = impulse(model, forces, state.species[particle], before, model.clock(state.step) - 1);
        for axis in 0..3 {
            let sum = first[axis] as f64 * first_momentum[axis] as f64
                + impulses[particle][axis] as f64 * momentum[axis] as f64;
            work += sum * model.units.momentum * model.units.momentum / masses[particle];
        }
    }
    work
}

/// Sum of the impulses of all particles.
fn sum(impulses: &[[i64; 3]]) -> [i64; 3] {
    impulses.iter().fold([0; 3], |sum, one| std::array::from_fn(|axis| sum[axis] + one[axis]))
}

/// The account of the next step, with both halves of this one; empty without body forces.
pub(crate) fn account(model: &Model, state: &State, masses: &[f64]) -> Vec<Account> {
    let Some(forces) = model.particles().body_forces.as_ref() else { return Vec::new() };
    let impulses = impulses(model, forces, state);
    let so_far = state.account.first().copied().unwrap_or_default();
    let halves = if model.clock(state.step) > 0 { 2 } else { 1 };
    let [given, sum] = [so_far.momentum(), sum(&impulses)];
    let work = (work(model, forces, state, masses, &impulses) / quanta(model).energy).round() as i64;
    vec![Account::new(std::array::from_fn(|axis| given[axis] + halves * sum[axis]), so_far.work() + work)]
}

/// What body forces have given up to the report point of a state.
pub(crate) fn transfer(model: &Model, state: &State, masses: &[f64]) -> Transfer {
    let Some(forces) = model.particles().body_forces.as_ref() else { return Transfer::default() };
    let impulses = impulses(model, forces, state);
    let so_far = state.account.first().copied().unwrap_or_default();
    let [given, sum] = [so_far.momentum(), sum(&impulses)];
    let closed = if model.clock(state.step) > 0 { sum } else { [0; 3] };
    Transfer {
        momentum: std::array::from_fn(|axis| (given[axis] + closed[axis]) as f64 * model.units.momentum),
        work: so_far.work() as f64 * quanta(model).energy + work(model, forces, state, masses, &impulses),
    }
}
