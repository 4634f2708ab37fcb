//! The Markov limit of Cotter and Reich's scheme, doi:10.1209/epl/i2003-00621-8, equations (18)-(21).
//!
//! ```text
//! p(n+½) = p(n) - dt/2 [∇V + Σ ∇h s(n)]                          (18)
//! r(n+1) = r(n) + dt p(n+½) / m                                  (19)
//! s(n+1) = γ/dt [h(r(n+1)) - h(r(n))] + √(2γkT/dt) ζ             (20)
//! p(n+1) = p(n+½) - dt/2 [∇V + Σ ∇h s(n+1)]                      (21)
//! ```
//! with h = φ(|rᵢ - rⱼ|), φ' = √ω: Groot and Warren's scheme with λ = ½, whose friction is the discrete gradient of
//! h over the last drift. That drift is computed again from the momenta that made it; at step 0 it is taken to have
//! been made by the initial momenta.

use super::groot_warren::half_kicks;
use super::pairs::{Pair, dot};
use super::{Reference, Report};

/// Half kicks by all forces at the report point.
pub(super) fn report(reference: &Reference, found: &[Pair]) -> Report {
    let model = &reference.model;
    let Some(force) = model.pair_force() else { return half_kicks(reference, found, |_, _| 0.0) };
    let drifts = reference.drifts();
    half_kicks(reference, found, |pair, forces| {
        let before = std::array::from_fn(|axis| {
            let drift = drifts[pair.first][axis] - drifts[pair.second][axis];
            pair.separation[axis] - drift as f64 * model.units.lengths[axis] / 4_294_967_296.0
        });
        let coupling = |distance| coupling(distance, force.cutoff, force.weight_exponent);
        let change = coupling(pair.distance) - coupling(dot(before, before).sqrt());
        -forces.friction * forces.weight * change / model.time_step
    })
}

/// φ(r), whose derivative is √ω within the cutoff; constant beyond it.
pub(super) fn coupling(distance: f64, cutoff: f64, weight_exponent: f64) -> f64 {
    let power = weight_exponent / 2.0 + 1.0;
    -cutoff / power * (1.0 - distance / cutoff).max(0.0).powf(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coupling_has_the_weight_as_its_derivative() {
        for exponent in [0.5, 1.0, 2.0, 3.0] {
            for distance in [0.1, 0.7, 1.4] {
                let slope =
                    (coupling(distance + 1e-6, 1.5, exponent) - coupling(distance - 1e-6, 1.5, exponent)) / 2e-6;
                let weight = (1.0_f64 - distance / 1.5).powf(exponent / 2.0);
                assert!((slope - weight).abs() < 1e-8, "{exponent} {distance}: {slope} {weight}");
            }
            assert_eq!(coupling(1.6, 1.5, exponent), 0.0);
        }
    }
}
