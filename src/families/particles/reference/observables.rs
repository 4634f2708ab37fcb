//! Sums over particles and pairs at the report point.

use super::pairs::{Forces, Pair, find_pairs};
use super::{Reference, Report};
use crate::families::{Model, Observables};
use crate::state::State;

/// What is observed of the motion: momenta p(n) of particles of some masses. The configuration is left at zero.
pub(super) fn of_motion(model: &Model, state: &State, masses: &[f64], momenta: &[[i64; 3]]) -> Observables {
    let mut total = [0_i64; 3];
    let mut kinetic_energy = 0.0;
    for (momentum, mass) in momenta.iter().zip(masses) {
        for axis in 0..3 {
            total[axis] += momentum[axis];
            kinetic_energy += (momentum[axis] as f64 * model.units.momentum).powi(2) / (2.0 * mass);
        }
    }
    Observables {
        mass: masses.iter().sum(),
        kinetic_energy,
        momentum: total.map(|units| units as f64 * model.units.momentum),
        ..Observables::zero(model, state)
    }
}

/// All observables of the report point.
pub(super) fn observe(reference: &Reference, found: &[Pair], report: &Report) -> Observables {
    let (model, state) = (&reference.model, &reference.state);
    let dimension = model.units.dimension;
    let mut observables = of_motion(model, state, &reference.masses, &report.momenta);
    observables.total_virial = report.total_virial;
    let mut gradients = vec![[0.0; 3]; state.len()];
    for pair in found {
        let potential = Forces::between(model, &state.species, pair).potential;
        observables.potential_energy += potential.energy;
        observables.conservative_virial += potential.virial(pair.distance);
        // Both ends have the same Laplacian.
        observables.laplacian += 2.0 * potential.laplacian(pair.distance, dimension);
        let gradient = potential.gradient(pair);
        for axis in 0..3 {
            gradients[pair.first][axis] += gradient[axis];
            gradients[pair.second][axis] -= gradient[axis];
        }
    }
    observables.gradient_squared = gradients.iter().flatten().map(|component| component * component).sum();
    observables
}

/// Counts of unordered pairs in `bins` equal bins of distance up to `range`.
pub(super) fn radial_distribution(reference: &Reference, range: f64, bins: usize) -> Vec<u64> {
    let mut counts = vec![0; bins];
    for pair in find_pairs(&reference.model.units, &reference.state.positions, range) {
        // Rounding may carry a distance just under the range to the end of the last bin.
        let bin = (pair.distance / range * bins as f64) as usize;
        if let Some(count) = counts.get_mut(bin) {
            *count += 1;
        }
    }
    counts
}
