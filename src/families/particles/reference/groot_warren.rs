//! The modified velocity Verlet scheme of Groot and Warren, doi:10.1063/1.474784, equations (18).
//!
//! ```text
//! r(n+1) = r(n) + dt v(n) + dt²/2 f(n)          = r(n) + dt v(n+½)
//! ṽ(n+1) = v(n) + λ dt f(n)
//! f(n+1) = f(r(n+1), ṽ(n+1))
//! v(n+1) = v(n) + dt/2 (f(n) + f(n+1))
//! ```
//! The state keeps p(n-½), and the m ṽ(n) that the friction sees where λ ≠ ½ makes it something else. With the half
//! kick H = dt/2 f, p(n) = p(n-½) + H(n), p(n+½) = p(n) + H(n) and m ṽ(n+1) = p(n+½) + (2λ - 1) H(n).

use super::pairs::{self, Forces, Pair, dot};
use super::{Reference, Report};
use crate::families::reference::{add, widen};
use crate::noise::{self, stream};

/// Half kicks by all forces at the report point; the friction is that of the predicted velocities.
pub(super) fn report(reference: &Reference, found: &[Pair]) -> Report {
    let state = &reference.state;
    let seen = widen(if state.predicted.is_empty() { &state.momenta } else { &state.predicted });
    half_kicks(reference, found, |pair, forces| {
        let approach = dot(pair.direction(), reference.relative_velocity(&seen, pair));
        -forces.friction * forces.weight * forces.weight * approach
    })
}

/// Half kicks by the conservative force, a given friction force along e, and noise of amplitude σ = √(2γkT).
pub(super) fn half_kicks(reference: &Reference, found: &[Pair], friction: impl Fn(&Pair, &Forces) -> f64) -> Report {
    let (model, state) = (&reference.model, &reference.state);
    let key = noise::step_key(model.seed, stream::PAIR, state.step);
    let mut kick = vec![[0; 3]; state.len()];
    let mut total_virial = 0.0;
    for pair in found {
        let forces = Forces::between(model, &state.species, pair);
        let amplitude = (2.0 * forces.friction * model.pair_temperature()).sqrt();
        let mut force = forces.potential.force() + friction(pair, &forces);
        if amplitude > 0.0 {
            force += amplitude * forces.weight * pairs::noise(model, key, pair) / model.time_step.sqrt();
        }
        let impulse = pair.direction().map(|component| 0.5 * model.time_step * force * component);
        pairs::exchange(&mut kick, pair, impulse, model.units.momentum);
        total_virial += pair.distance * force;
    }
    let mut momenta = widen(&state.momenta);
    // The momenta of step 0 are those of the report point already.
    if state.step > 0 {
        add(&mut momenta, &kick);
    }
    Report { momenta, kick, total_virial }
}
