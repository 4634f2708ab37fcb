//! From the integer sums of a report to observables of particles.

use super::plan::{external, walls};
use crate::families::{BathProducts, Column, Model, Observables, OnWalls, Particles, PutIn, column};
use crate::plan::Plan;

/// The observables of a step from the sums of its report.
pub(super) fn observables(step: u64, sums: &[i64], plan: &Plan, model: &Model) -> Observables {
    let sum = |index: usize| sums.get(index).map_or(f64::NAN, |sum| *sum as f64);
    let quanta = plan.quanta;
    // Energy, square and number of the baths follow, where there are any that remember; in steps that relax in two stages the
    // virial of the first; then what walls have taken up and what body forces have put in.
    let staged = model.particles().relaxes_in_two_stages(model);
    let from_outside = walls::sums(model) + external::sums(model);
    let remembering = !staged && sums.len() as u64 - from_outside.min(sums.len() as u64) > 9;
    let put_in = put_in_place(model).map_or_else(PutIn::default, |first| PutIn {
        momentum: [0, 1, 2].map(|axis| sum(first + axis) * model.units.momentum),
        work: sum(first + 3) * quanta.energy,
    });
    let on_walls = walls_place(model).map_or_else(OnWalls::default, |(first, number)| {
        OnWalls::new(model, (0..number).map(|wall| [0, 1, 2].map(|axis| sum(first + 3 * wall + axis))))
    });
    let products = quanta.bath_products;
    let coordinates = model.particles().oscillating_coordinates(model);
    let bath_products = if coordinates > 0 {
        BathProducts {
            momentum: sum(12) * products.momentum / coordinates as f64,
            displacement: sum(13) * products.displacement / coordinates as f64,
            momentum_displacement: sum(14) * products.momentum_displacement / coordinates as f64,
        }
    } else {
        BathProducts::default()
    };
    Observables {
        step,
        particles: plan.particles,
        mobile: model.mobile_particles(),
        dimension: model.units.dimension,
        volume: model.units.volume(),
        mass: model.mobile_mass(),
        kinetic_energy: sum(0) * quanta.energy,
        total_virial: (sum(1) + if staged { sum(9) } else { 0.0 }) * quanta.pair_energy,
        momentum: [2, 3, 4].map(|index| sum(index) * model.units.momentum),
        potential_energy: sum(5) * quanta.pair_energy,
        conservative_virial: sum(6) * quanta.pair_energy,
        gradient_squared: sum(7) * quanta.force_squared,
        laplacian: sum(8) * quanta.curvature,
        about_centre_of_mass: model.measures_about_centre_of_mass(),
        bath_energy: if remembering { sum(9) * quanta.pair_energy } else { 0.0 },
        bath_square: if remembering && sum(11) > 0.0 { sum(10) * quanta.bath_squared / sum(11) } else { 0.0 },
        bath_products,
        put_in,
        on_walls,
        cells: None,
    }
}

/// The number of sums before those of walls and body forces.
fn own_sums(model: &Model) -> usize {
    let products = if model.particles().oscillates_in_memory() { 3 } else { 0 };
    let remembering = if model.has_memory() { 3 } else { 0 };
    9 + usize::from(model.particles().relaxes_in_two_stages(model)) + remembering + products
}

/// The place of the first sum of what walls have taken up, and their number, if there are any.
pub(super) fn walls_place(model: &Model) -> Option<(usize, usize)> {
    let number = walls::count(model);
    (number > 0).then(|| (own_sums(model), number))
}

/// The place of the first sum of what body forces have put in, if there are any.
pub(super) fn put_in_place(model: &Model) -> Option<usize> {
    model.particles().body_forces.as_ref().map(|_| own_sums(model) + walls::sums(model) as usize)
}

/// The columns of the table of energies.
pub(super) fn columns(particles: &Particles, model: &Model) -> Vec<Column> {
    let potential = model.has_potential();
    let mut columns = vec![column::TIME, column::KINETIC_ENERGY];
    columns.extend(potential.then_some(column::POTENTIAL_ENERGY));
    columns.push(column::TOTAL_ENERGY);
    if model.has_memory() {
        columns.extend(column::BATH_ENERGIES);
        columns.push(column::BATH_SQUARE);
    }
    if particles.oscillates_in_memory() {
        columns.extend(column::BATH_PRODUCTS);
    }
    // Harmonic chains are at temperature zero and at that of the scene side by side.
    columns.extend(particles.chains.is_none().then_some(column::TEMPERATURE));
    // Curvature is summed over all particles, and the force on those that are held is not one of heat.
    if potential && !model.has_fixed_particles() && particles.angles.is_none() {
        columns.push(column::CONFIGURATIONAL_TEMPERATURE);
    }
    // What is tied to places in space presses on nothing.
    if particles.tether.is_none() && !model.has_fixed_particles() {
        columns.push(column::PRESSURE);
        columns.extend(potential.then_some(column::CONSERVATIVE_PRESSURE));
    }
    columns.extend(column::motion(model.units.dimension));
    if particles.body_forces.is_some() {
        columns.extend(column::put_in(model.units.dimension));
    }
    columns.extend(column::on_walls(particles.walls.iter().map(|walls| walls.axis), model.units.dimension));
    columns.extend(particles.shear.is_some().then_some(column::SHEAR_MOMENTUM));
    columns.extend(particles.walls_move().then_some(column::WALL_WORK));
    columns
}
