//! From the integer sums of a report to observables of shallow water.

use crate::families::{Column, Model, Observables, ShallowWater, column};
use crate::plan::{Plan, Sums};
use crate::shaders::Sum;

/// What a report of shallow water sums.
pub(super) fn sums() -> Sums {
    Sums::default()
        .with(Sum::KineticEnergy, 1)
        .with(Sum::Momentum, 2)
        .with_if(true, &[Sum::PotentialEnergy, Sum::BathSquare, Sum::Mass])
}

/// The observables of a step from the row of its report.
pub(super) fn observables(step: u64, values: &[i64], plan: &Plan, model: &Model, water: &ShallowWater) -> Observables {
    let sums = sums();
    let row = sums.row(values);
    let quanta = plan.quanta;
    let bath_squares = row.number(Sum::BathSquare) * quanta.bath_squared;
    let energy_per_square = match &water.bath {
        Some(bath) if bath.continuous_coupling.is_finite() && bath.continuous_coupling > 0.0 => {
            0.5 * water.wave_speed.powi(2) / bath.continuous_coupling
        }
        _ => 0.0,
    };
    Observables {
        particles: water.carriers,
        mobile: water.carriers,
        mass: water.total_mass() as f64 * water.mass_unit,
        kinetic_energy: row.number(Sum::KineticEnergy) * quanta.energy,
        momentum: row.vector(Sum::Momentum, 0).map(|sum| sum * quanta.energy / water.wave_speed),
        potential_energy: row.number(Sum::PotentialEnergy) * quanta.pair_energy,
        bath_energy: energy_per_square * bath_squares,
        bath_square: bath_squares / water.nodes() as f64,
        conservative_virial: f64::NAN,
        total_virial: f64::NAN,
        ..Observables::at(model, step)
    }
}

/// The columns of the table of energies.
pub(super) fn columns(water: &ShallowWater, model: &Model) -> Vec<Column> {
    let mut columns = vec![column::TIME, column::KINETIC_ENERGY, column::POTENTIAL_ENERGY, column::TOTAL_ENERGY];
    if model.has_memory() {
        columns.extend(column::BATH_ENERGIES);
    }
    columns.extend(water.bath.is_some().then_some(column::BATH_SQUARE));
    columns.push(column::TEMPERATURE);
    columns.extend(column::motion(2));
    columns
}
