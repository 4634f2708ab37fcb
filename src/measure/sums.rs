//! From the integer sums of a report to observables in real units.

use super::Observables;
use crate::engine::Sample;
use crate::model::Model;
use crate::plan::Plan;

/// The observables of one sample of the first sampler of a plan.
#[must_use]
pub fn observables_of(sample: &Sample, plan: &Plan, model: &Model) -> Observables {
    let sum = |index: usize| sample.sums.get(index).map_or(f64::NAN, |sum| *sum as f64);
    let quanta = plan.quanta;
    Observables {
        step: sample.step,
        particles: plan.particles,
        dimension: model.units.dimension,
        volume: model.units.volume(),
        mass: model.species.iter().map(|species| species.mass * species.count as f64).sum(),
        kinetic_energy: sum(0) * quanta.energy,
        total_virial: sum(1) * quanta.pair_energy,
        momentum: [2, 3, 4].map(|index| sum(index) * model.units.momentum),
        potential_energy: sum(5) * quanta.pair_energy,
        conservative_virial: sum(6) * quanta.pair_energy,
        gradient_squared: sum(7) * quanta.force_squared,
        laplacian: sum(8) * quanta.curvature,
        momentum_is_constant: true,
        bath_energy: 0.0,
        bath_square: 0.0,
    }
}
