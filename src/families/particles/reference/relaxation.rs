//! The part of O that is exact, whatever the friction and the step: the relaxation of single particles, and of bonds
//! one after the other, on momenta that are rounded to whole units once.

use super::held;
use super::pairs::{self, dot};
use super::shear::{self, Images};
use super::stress::Virials;
use super::terms::bonds::span;
use crate::families::Model;
use crate::noise::{self, stream};
use crate::state::State;

/// Friction and noise of every particle by itself: each component of its momentum is an Ornstein-Uhlenbeck process,
/// p' = c p + √(mkT(1 - c²)) ξ with c = exp(-γdt/m).
pub(super) fn of_particles(model: &Model, state: &State, masses: &[f64], momenta: &mut [[i64; 3]]) {
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

/// Friction and noise along bonds, in rounds of bonds that share no particle. The velocity u along a bond of reduced
/// mass μ is an Ornstein-Uhlenbeck process, u' = c u + √(kT(1 - c²)/μ) ξ with c = exp(-γdt/μ), and the ends get ±μ(u' -
/// u).
pub(super) fn of_bonds(model: &Model, state: &State, masses: &[f64], momenta: &mut [[i64; 3]], virials: &mut Virials) {
    let Some(bonds) = model.particles().bonds.as_ref().filter(|_| model.particles().relaxes_bonds(model)) else {
        return;
    };
    let images = Images::of_step(model, state.step);
    let key = noise::step_key(model.seed, stream::BOND, model.clock(state.step));
    for (place, bond) in bonds.rounds().into_iter().flatten() {
        let kind = &bonds.kinds[bond.kind as usize];
        let Some(bath) = &kind.bath else { continue };
        let pair = span(&images, &bond, &state.positions);
        let [first, second] = [pair.first, pair.second]
            .map(|end| momenta[end].map(|units| units as f64 * model.units.momentum / masses[end]));
        let mut relative: [f64; 3] = std::array::from_fn(|axis| first[axis] - second[axis]);
        relative[0] -= pair.boxes_up as f64 * model.particles().shear.as_ref().map_or(0.0, |shear| shear.velocity);
        let velocity = dot(pair.direction(), relative);
        let inverse_mass = |end: usize| if held::is_held(model, state, end) { 0.0 } else { 1.0 / masses[end] };
        let reduced_mass = 1.0 / (inverse_mass(pair.first) + inverse_mass(pair.second));
        // Two held ends have no motion to relax.
        if reduced_mass.is_infinite() {
            continue;
        }
        let friction = 0.5 * model.time_step * bath.coupling;
        let kept = (-friction * model.time_step / reduced_mass).exp();
        let gaussian = noise::gaussian(noise::words(model.generator, key, [place, 0]));
        let after = kept * velocity + (kind.temperature * (1.0 - kept * kept) / reduced_mass).sqrt() * gaussian;
        let impulse = reduced_mass * (after - velocity);
        let impulses = pair.direction().map(|component| impulse * component);
        pairs::exchange(momenta, &pair, impulses, model.units.momentum);
        for end in [pair.first, pair.second].into_iter().filter(|end| held::is_held(model, state, *end)) {
            momenta[end] = state.momenta[end].map(i64::from);
        }
        virials.add(&pair, 0.0, impulse / model.time_step);
    }
}
