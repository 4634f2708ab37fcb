//! Sums over particles and pairs at the report point.

use super::pairs::{Forces, Pair, find_pairs};
use super::{Reference, Report};
use crate::families::Observables;

/// All observables of the report point.
pub(super) fn observe(reference: &Reference, found: &[Pair], report: &Report) -> Observables {
    let (model, state) = (&reference.model, &reference.state);
    let dimension = model.units.dimension;
    let mut observables = Observables {
        step: state.step,
        particles: state.len() as u64,
        mobile: model.mobile_particles(),
        dimension,
        volume: model.units.volume(),
        mass: reference.masses.iter().sum(),
        kinetic_energy: 0.0,
        potential_energy: 0.0,
        gradient_squared: 0.0,
        laplacian: 0.0,
        conservative_virial: 0.0,
        total_virial: report.total_virial,
        momentum: [0.0; 3],
        about_centre_of_mass: model.measures_about_centre_of_mass(),
        bath_energy: 0.0,
        bath_square: 0.0,
        cells: None,
    };
    let mut total = [0_i64; 3];
    for (momentum, mass) in report.momenta.iter().zip(&reference.masses) {
        for axis in 0..3 {
            total[axis] += momentum[axis];
            observables.kinetic_energy += (momentum[axis] as f64 * model.units.momentum).powi(2) / (2.0 * mass);
        }
    }
    observables.momentum = total.map(|units| units as f64 * model.units.momentum);

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
