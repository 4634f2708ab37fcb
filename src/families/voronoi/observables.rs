//! From the integer sums of a report to observables of Voronoi cells.

use crate::document::CellIntegrator;
use crate::families::column::column;
use crate::families::{CellObservables, Column, Model, Observables, Voronoi, column};
use crate::plan::{Plan, Sums};
use crate::shaders::Sum;

/// The residual of the solver of the friction is counted in these.
const RESIDUAL: f64 = 1.0 / (1_u64 << 40) as f64;

/// What a report of cells sums.
pub(super) fn sums(cells: &Voronoi, model: &Model) -> Sums {
    let energies = cells.keeps_energy();
    let (solves, limited) = (cells.solves(), cells.has_limits(model.temperature));
    Sums::default()
        .with(Sum::KineticEnergy, 1)
        .with(Sum::Momentum, 2)
        .with_if(true, &[Sum::Mass, Sum::Volume, Sum::FaceSides])
        .with_if(energies, &[Sum::InternalEnergy, Sum::TotalEnergy, Sum::Temperature])
        .with_if(!energies && !cells.exchanges_mass(), &[Sum::PotentialEnergy])
        .with_if(solves || limited, &[Sum::LimitedExchanges])
        .with_if(solves, &[Sum::Iterations, Sum::Residual])
}

/// The observables of a step from the row of its report.
pub(super) fn observables(step: u64, values: &[i64], plan: &Plan, model: &Model, cells: &Voronoi) -> Observables {
    let sums = sums(cells, model);
    let row = sums.row(values);
    let whole = |sum: Sum| row.value(sum).unwrap_or(0);
    let (units, quanta) = (model.units, plan.quanta);
    let kinetic_energy = row.number(Sum::KineticEnergy) * quanta.energy;
    let mass_units = whole(Sum::Mass);
    let mass = mass_units as f64 * cells.mass_unit;
    // What one molecule has of both, as an ideal gas of two dimensions, and with it the product of pressure and volume.
    let (free_energy, internal_energy, internal_temperature) = if cells.keeps_energy() {
        // Kinetic and internal energy together are integers, whose sum says whether any is lost.
        let internal = whole(Sum::TotalEnergy) as f64 * cells.energy_unit - kinetic_energy;
        (0.0, internal, row.number(Sum::Temperature) * quanta.energy / plan.particles as f64)
    } else {
        let free_energy = row.number(Sum::PotentialEnergy) * quanta.energy;
        (free_energy, mass / cells.molecular_mass * model.temperature, model.temperature)
    };
    Observables {
        mass,
        kinetic_energy,
        momentum: row.vector(Sum::Momentum, 0).map(|sum| sum * units.momentum),
        potential_energy: free_energy,
        conservative_virial: 2.0 * internal_energy,
        total_virial: f64::NAN,
        cells: Some(CellObservables {
            volume: row.number(Sum::Volume) * quanta.length_squared,
            // Every face has two sides.
            faces: whole(Sum::FaceSides) as u64 / 2,
            mass_units,
            internal_energy,
            internal_temperature,
            pressure: internal_energy / units.volume(),
            limited_exchanges: whole(Sum::LimitedExchanges) as u64,
            iterations: whole(Sum::Iterations) as u64,
            residual: whole(Sum::Residual) as f64 * RESIDUAL,
        }),
        ..Observables::at(model, step)
    }
}

/// The columns of the table of energies.
pub(super) fn columns(cells: &Voronoi, model: &Model) -> Vec<Column> {
    let potential = model.physics().has_potential();
    let mut columns = vec![column::TIME, column::KINETIC_ENERGY];
    // The free energy of cells that exchange mass derives no force.
    if potential {
        columns.extend([column::POTENTIAL_ENERGY, column::TOTAL_ENERGY]);
    }
    if cells.keeps_energy() {
        columns.push(column("internal_energy", |row, _| of_cells(row, |cells| cells.internal_energy)));
        columns
            .push(column("total_energy", |row, _| row.kinetic_energy + of_cells(row, |cells| cells.internal_energy)));
    }
    columns.push(column::TEMPERATURE);
    if cells.keeps_energy() {
        columns.push(column("internal_temperature", |row, _| of_cells(row, |cells| cells.internal_temperature)));
    }
    columns.push(column::PRESSURE);
    columns.extend(column::motion(2));
    columns.extend([
        column("mass", |row, _| row.mass),
        column("volume_error", |row, _| of_cells(row, |cells| cells.volume / row.volume - 1.0)),
        column("mean_neighbours", |row, _| of_cells(row, |cells| 2.0 * cells.faces as f64 / row.particles as f64)),
    ]);
    if cells.has_limits(model.temperature) {
        columns.push(column(column::LIMITED_EXCHANGES, |row, _| of_cells(row, |cells| cells.limited_exchanges as f64)));
    }
    if cells.viscosity > 0.0 && cells.integrator == (CellIntegrator::Splitting {}) {
        columns.push(column("solver_iterations", |row, _| of_cells(row, |cells| cells.iterations as f64)));
        columns.push(column("solver_residual", |row, _| of_cells(row, |cells| cells.residual)));
    }
    columns
}

/// A quantity of Voronoi cells.
fn of_cells(row: &Observables, quantity: impl Fn(&CellObservables) -> f64) -> f64 {
    row.cells.as_ref().map_or(f64::NAN, quantity)
}
