//! From the integer sums of a report to observables of particles.

use super::space::walls::plan as walls;
use super::sums::sums;
use crate::families::particles::terms::electrostatics::Electrostatics;
use crate::families::{BathProducts, Column, Model, Observables, OnWalls, Particles, Transfer, column};
use crate::plan::Plan;
use crate::shaders::Sum;

/// The observables of a step from the row of its report.
pub(super) fn observables(step: u64, values: &[i64], plan: &Plan, model: &Model) -> Observables {
    let sums = sums(model);
    let row = sums.row(values);
    let (units, quanta) = (model.units, plan.quanta);
    let products = quanta.bath_products;
    let coordinates = model.particles().oscillating_coordinates(model).max(1) as f64;
    let baths = row.number(Sum::BathCount);
    // Waves count every charge by itself.
    let electrostatics = model.particles().electrostatics.as_ref();
    let [own_energy, own_laplacian] = electrostatics.map_or([0.0; 2], |electrostatics| {
        let volume = units.lengths.iter().product();
        let mobile = Electrostatics::mobile_part(&model.species);
        [electrostatics.own_energy(), mobile * electrostatics.own_laplacian(volume)]
    });
    Observables {
        mass: model.mobile_mass(),
        kinetic_energy: row.number(Sum::KineticEnergy) * quanta.energy,
        total_virial: (row.number(Sum::Virial) + row.number(Sum::FirstStageVirial)) * quanta.pair_energy,
        momentum: row.vector(Sum::Momentum, 0).map(|sum| sum * units.momentum),
        potential_energy: row.number(Sum::PotentialEnergy) * quanta.pair_energy - own_energy,
        conservative_virial: row.number(Sum::ConservativeVirial) * quanta.pair_energy,
        gradient_squared: row.number(Sum::SquaredForce) * quanta.force_squared,
        laplacian: row.number(Sum::Curvature) * quanta.curvature + own_laplacian,
        electrostatic_energy: row.number(Sum::ElectrostaticEnergy) * quanta.pair_energy - own_energy,
        bath_energy: row.number(Sum::BathEnergy) * quanta.pair_energy,
        bath_square: if baths > 0.0 { row.number(Sum::BathSquare) * quanta.bath_squared / baths } else { 0.0 },
        bath_products: BathProducts {
            momentum: row.number(Sum::BathMomentum) * products.momentum / coordinates,
            displacement: row.number(Sum::BathDisplacement) * products.displacement / coordinates,
            momentum_displacement: row.number(Sum::MomentumDisplacement) * products.momentum_displacement / coordinates,
        },
        from_body_forces: Transfer {
            momentum: row.vector(Sum::GivenMomentum, 0).map(|sum| sum * units.momentum),
            work: row.number(Sum::GivenWork) * quanta.energy,
        },
        on_walls: OnWalls::new(model, (0..walls::count(model)).map(|wall| row.vector(Sum::Walls, 3 * wall))),
        ..Observables::at(model, step)
    }
}

/// The columns of the table of energies.
pub(super) fn columns(particles: &Particles, model: &Model) -> Vec<Column> {
    let potential = model.physics().has_potential();
    let mut columns = vec![column::TIME, column::KINETIC_ENERGY];
    columns.extend(potential.then_some(column::POTENTIAL_ENERGY));
    columns.extend(particles.electrostatics.is_some().then_some(column::ELECTROSTATIC_ENERGY));
    columns.push(column::TOTAL_ENERGY);
    if model.has_memory() {
        columns.extend(column::BATH_ENERGIES);
        columns.push(column::BATH_SQUARE);
    }
    if particles.oscillates_in_memory() {
        columns.extend(column::BATH_PRODUCTS);
    }
    columns.extend((!particles.side_by_side).then_some(column::TEMPERATURE));
    // Curvature is summed over all particles, and the force on those that are held is not one of heat.
    if potential && !model.has_fixed_particles() && particles.angles.is_none() {
        columns.push(column::CONFIGURATIONAL_TEMPERATURE);
    }
    // What is tied to places in space presses on nothing.
    if particles.tethers.is_none() && !model.has_fixed_particles() {
        columns.push(column::PRESSURE);
        columns.extend(potential.then_some(column::CONSERVATIVE_PRESSURE));
    }
    columns.extend(column::motion(model.units.dimension));
    if particles.body_forces.is_some() {
        columns.extend(column::body_forces(model.units.dimension));
    }
    columns.extend(column::on_walls(particles.walls.iter().map(|walls| walls.axis), model.units.dimension));
    columns.extend(particles.shear.is_some().then_some(column::SHEAR_MOMENTUM));
    columns.extend(particles.walls_move().then_some(column::WALL_WORK));
    columns
}
