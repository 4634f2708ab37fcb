//! What is measured of a state.

use super::VoronoiReference;
use super::equation_of_state;
use super::faces::{Cells, dot};
use crate::families::{CellObservables, Observables};
use crate::tessellation::Tessellation;

/// Measures a state with a tessellation of its own.
///
/// The virial of the pressures is Σ r·F = 2 Σ pV in two dimensions, whatever the form; that of friction and noise is not
/// measured. Cells of constant mass and temperature have a potential, the free energy of the gas in them.
pub(super) fn observe(reference: &VoronoiReference) -> Observables {
    let VoronoiReference { model, cells, state, .. } = reference;
    let tessellation = Tessellation::of_fractions([model.units.lengths[0], model.units.lengths[1]], &state.positions);
    let volumes: Vec<f64> = tessellation.cells.iter().map(|cell| cell.volume).collect();
    let now = Cells::of(model, cells, state, &volumes);
    let box_volume = model.units.volume();
    let mut observables =
        Observables { mass: now.masses.iter().sum(), total_virial: f64::NAN, ..Observables::zero(model, state) };
    let total = state.total_momentum();
    observables.momentum = std::array::from_fn(|axis| total[axis] as f64 * model.units.momentum);
    let has_potential = !cells.exchanges_mass() && !cells.keeps_energy();
    let mut pressures = 0.0;
    for cell in 0..state.len() {
        observables.kinetic_energy += 0.5 * now.masses[cell] * dot(now.velocities[cell], now.velocities[cell]);
        pressures += now.pressures[cell] * volumes[cell];
        if has_potential {
            let mean_volumes = volumes[cell] * state.len() as f64 / box_volume;
            observables.potential_energy +=
                equation_of_state::free_energy(cells, now.masses[cell], model.temperature, mean_volumes);
        }
    }
    observables.conservative_virial = 2.0 * pressures;
    let sides: usize = tessellation.cells.iter().map(|cell| cell.faces.len()).sum();
    observables.cells = Some(CellObservables {
        volume: volumes.iter().sum(),
        faces: sides as u64 / 2,
        mass_units: state.masses.iter().map(|units| i64::from(*units)).sum(),
        internal_energy: now.internal_energies.iter().sum(),
        internal_temperature: now.temperatures.iter().sum::<f64>() / state.len() as f64,
        pressure: pressures / box_volume,
        limited_exchanges: reference.limited,
        iterations: reference.iterations,
        residual: reference.residual,
    });
    observables
}
