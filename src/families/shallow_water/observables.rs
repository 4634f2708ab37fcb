//! From the integer sums of a report to observables of shallow water.

use crate::families::{BathProducts, Column, Model, Observables, OnWalls, PutIn, ShallowWater, column};
use crate::plan::Plan;

/// The observables of a step from the sums of its report.
pub(super) fn observables(step: u64, sums: &[i64], plan: &Plan, model: &Model, water: &ShallowWater) -> Observables {
    let sum = |index: usize| sums.get(index).map_or(f64::NAN, |sum| *sum as f64);
    let quanta = plan.quanta;
    let bath_squares = sum(4) * quanta.bath_squared;
    let energy_per_square = match &water.bath {
        Some(bath) if bath.continuous_coupling.is_finite() && bath.continuous_coupling > 0.0 => {
            0.5 * water.wave_speed.powi(2) / bath.continuous_coupling
        }
        _ => 0.0,
    };
    Observables {
        step,
        particles: water.carriers,
        mobile: water.carriers,
        dimension: 2,
        volume: model.units.volume(),
        mass: water.total_mass() as f64 * water.mass_unit,
        kinetic_energy: sum(0) * quanta.energy,
        momentum: [sum(1), sum(2), 0.0].map(|sum| sum * quanta.energy / water.wave_speed),
        potential_energy: sum(3) * quanta.pair_energy,
        bath_energy: energy_per_square * bath_squares,
        bath_square: bath_squares / water.nodes() as f64,
        bath_products: BathProducts::default(),
        put_in: PutIn::default(),
        on_walls: OnWalls::default(),
        cells: None,
        about_centre_of_mass: false,
        gradient_squared: 0.0,
        laplacian: 0.0,
        conservative_virial: f64::NAN,
        total_virial: f64::NAN,
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
