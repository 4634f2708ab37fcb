//! Pairs without memory in a leapfrog step: closing and opening half kicks by the same forces, then the drift.
//!
//! Groot and Warren's modified velocity Verlet scheme, doi:10.1063/1.474784, equations (18):
//!
//! ```text
//! r(n+1) = r(n) + dt v(n) + dt²/2 f(n)          = r(n) + dt v(n+½)
//! ṽ(n+1) = v(n) + λ dt f(n)
//! f(n+1) = f(r(n+1), ṽ(n+1))
//! v(n+1) = v(n) + dt/2 (f(n) + f(n+1))
//! ```
//! The state keeps p(n-½), and the m ṽ(n) that the friction sees where λ ≠ ½ makes it something else. With the half
//! kick H = dt/2 f, p(n) = p(n-½) + H(n), p(n+½) = p(n) + H(n) and m ṽ(n+1) = p(n+½) + (2λ - 1) H(n).
//!
//! The Markov limit of Cotter and Reich's scheme, doi:10.1209/epl/i2003-00621-8, equations (18)-(21):
//!
//! ```text
//! p(n+½) = p(n) - dt/2 [∇V + Σ ∇h s(n)]                          (18)
//! r(n+1) = r(n) + dt p(n+½) / m                                  (19)
//! s(n+1) = γ/dt [h(r(n+1)) - h(r(n))] + √(2γkT/dt) ζ             (20)
//! p(n+1) = p(n+½) - dt/2 [∇V + Σ ∇h s(n+1)]                      (21)
//! ```
//! with h = φ(|rᵢ - rⱼ|), φ' = √ω. That is the same scheme with λ = ½, but for its friction: the discrete gradient of h
//! over the last drift, in place of its derivative along the velocities, √ω e·(vᵢ - vⱼ). The drift is computed again
//! from the momenta that made it; at step 0 it is taken to have been made by the initial momenta.

use super::PairForce;
use super::densities::Densities;
use crate::families::particles::reference::{Configuration, Forces, Kicks, Moment, find_pairs, noise_of_pair};
use crate::families::particles::terms::bonds::reference::excluded_pairs;
use crate::families::reference::bath;
use crate::noise::{self, stream};

/// Adds half kicks by pairs without memory and their virials: without friction, where steps relax it by itself.
pub(super) fn kick(force: &PairForce, moment: &Moment<'_>, kicks: &mut Kicks) {
    let (model, state, motion) = (moment.model, moment.state, &moment.motion);
    let key = noise::step_key(model.seed, stream::PAIR, model.clock(state.step));
    let densities = Densities::of(model, state.len(), &moment.found);
    let excluded = excluded_pairs(model);
    let relaxes = model.particles().relaxes_pairs();
    for pair in &moment.found {
        let forces = Forces::between(model, &state.species, pair);
        let is_excluded = excluded.binary_search(&[pair.first as u32, pair.second as u32]).is_ok();
        let many_body = densities.as_ref().map_or(0.0, |densities| densities.force(pair));
        let repulsion = if is_excluded { 0.0 } else { forces.potential.force() + many_body };
        let mut friction = 0.0;
        if forces.friction > 0.0 && !relaxes {
            let species = [pair.first, pair.second].map(|end| state.species[end] as usize);
            let step = force.bath_step(species[0], species[1], model.time_step);
            let change = motion.approach(pair).map_or_else(
                || coupling(force, species, pair.distance) - coupling(force, species, motion.distance_before(pair)),
                |approach| forces.weight * approach,
            );
            // The noise of a pair pushes it apart; that of its bath would pull.
            let noise = -noise_of_pair(model, key, pair);
            friction = -forces.weight * bath::advanced(&step, force.temperature, 0.0, change, noise);
        }
        kicks.push_apart(model, pair, repulsion, friction);
    }
}

/// Adds the potentials of all pairs that no bond excludes, and of local densities.
pub(super) fn observe(force: &PairForce, sums: &mut Configuration<'_>) {
    let (model, state) = (sums.model, sums.state);
    let excluded = excluded_pairs(model);
    let found = find_pairs(sums.images, &state.positions, force.cutoff);
    for pair in &found {
        if excluded.binary_search(&[pair.first as u32, pair.second as u32]).is_err() {
            sums.add(pair, &Forces::between(model, &state.species, pair).potential);
        }
    }
    if let Some(densities) = Densities::of(model, state.len(), &found) {
        densities.observe(&found, sums);
    }
}

/// φ(r) of two species, whose derivative is √ω within their cutoff; zero from there on.
pub(super) fn coupling(force: &PairForce, [a, b]: [usize; 2], distance: f64) -> f64 {
    let (cutoff, power) = (force.friction_cutoff(a, b), force.weight_exponent(a, b) / 2.0 + 1.0);
    -cutoff / power * (1.0 - distance / cutoff).max(0.0).powf(power)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    use crate::scene;

    #[test]
    fn the_coupling_has_the_weight_as_its_derivative() {
        for weight_exponent in [0.5, 1.0, 2.0, 3.0] {
            let own = r#"[{"between":["fluid","fluid"],"cutoff":1.5,"weight_exponent":EXPONENT}]"#
                .replace("EXPONENT", &weight_exponent.to_string());
            let scene = scene::load("dpd-fluid", &[format!("interactions.0.pairs={own}")]).unwrap();
            let force = scene.model().particles().pair_force.clone().unwrap();
            let phi = |distance: f64| coupling(&force, [0, 0], distance);
            for distance in [0.1, 0.7, 1.4] {
                let slope = (phi(distance + 1e-6) - phi(distance - 1e-6)) / 2e-6;
                let weight = (1.0_f64 - distance / 1.5).powf(weight_exponent / 2.0);
                assert!((slope - weight).abs() < 1e-8, "{weight_exponent} {distance}: {slope} {weight}");
            }
            assert_eq!(phi(1.6), 0.0);
        }
    }
}
