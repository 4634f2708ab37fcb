//! The columns that tables of energies of several families have.

use super::Observables;

/// A column of the table of energies.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    value: Value,
}

/// The value of a column in a row.
#[derive(Debug, Clone, Copy)]
enum Value {
    /// A number, given the time.
    Number(fn(&Observables, f64) -> f64),
    /// A component of a vector.
    Component(fn(&Observables) -> [f64; 3], usize),
    /// A component of the momentum absorbed by a wall.
    OnWall(usize, usize),
}

impl Column {
    /// Its value in a row, given the time of that.
    pub(crate) fn value(&self, row: &Observables, time: f64) -> f64 {
        match self.value {
            Value::Number(number) => number(row, time),
            Value::Component(vector, axis) => vector(row)[axis],
            Value::OnWall(wall, axis) => row.on_walls.momentum[wall][axis],
        }
    }
}

/// A column.
pub(crate) const fn column(name: &'static str, number: fn(&Observables, f64) -> f64) -> Column {
    Column { name, value: Value::Number(number) }
}

/// The components of a vector, of those names.
fn components(names: [&'static str; 3], dimension: usize, vector: fn(&Observables) -> [f64; 3]) -> Vec<Column> {
    let component = |(axis, name): (usize, &&'static str)| Column { name, value: Value::Component(vector, axis) };
    names.iter().enumerate().take(dimension).map(component).collect()
}

/// Time.
pub(crate) const TIME: Column = column("time", |_, time| time);
/// Kinetic energy.
pub(crate) const KINETIC_ENERGY: Column = column("kinetic_energy", |row, _| row.kinetic_energy);
/// Potential energy.
pub(crate) const POTENTIAL_ENERGY: Column = column("potential_energy", |row, _| row.potential_energy);
/// The part of the potential energy that charges have.
pub(crate) const ELECTROSTATIC_ENERGY: Column = column("electrostatic_energy", |row, _| row.electrostatic_energy);
/// Kinetic and potential energy.
pub(crate) const TOTAL_ENERGY: Column = column("total_energy", |row, _| row.total_energy());
/// Energy of baths with memory, and that of all together.
pub(crate) const BATH_ENERGIES: [Column; 2] = [
    column("bath_energy", |row, _| row.bath_energy),
    column("extended_energy", |row, _| row.total_energy() + row.bath_energy),
];
/// Mean square of the variables of baths.
pub(crate) const BATH_SQUARE: Column = column("bath_square", |row, _| row.bath_square);
/// Covariances of oscillators and their baths.
pub(crate) const BATH_PRODUCTS: [Column; 3] = [
    column("bath_times_momentum", |row, _| row.bath_products.momentum),
    column("bath_times_displacement", |row, _| row.bath_products.displacement),
    column("momentum_times_displacement", |row, _| row.bath_products.momentum_displacement),
];
/// Kinetic temperature.
pub(crate) const TEMPERATURE: Column = column("temperature", |row, _| row.kinetic_temperature());
/// Configurational temperature.
pub(crate) const CONFIGURATIONAL_TEMPERATURE: Column =
    column("configurational_temperature", |row, _| row.configurational_temperature());
/// Pressure.
pub(crate) const PRESSURE: Column = column("pressure", |row, _| row.pressure());
/// Pressure of conservative forces.
pub(crate) const CONSERVATIVE_PRESSURE: Column = column("pressure_conservative", |row, _| row.conservative_pressure());
/// Exchanges that a limit has cut since the run began.
pub(crate) const LIMITED_EXCHANGES: &str = "limited_exchanges";

/// Components of the total momentum.
const MOMENTUM: [&str; 3] = ["momentum_x", "momentum_y", "momentum_z"];

/// The axis of which a column of this name is the component of the total momentum.
pub(crate) fn axis_of_momentum(name: &str) -> Option<usize> {
    MOMENTUM.iter().position(|component| *component == name)
}

/// Total momentum and velocity of the centre of mass.
pub(crate) fn motion(dimension: usize) -> Vec<Column> {
    const CENTRE_OF_MASS: [&str; 3] =
        ["center_of_mass_velocity_x", "center_of_mass_velocity_y", "center_of_mass_velocity_z"];
    let momentum = components(MOMENTUM, dimension, |row| row.momentum);
    [momentum, components(CENTRE_OF_MASS, dimension, Observables::centre_of_mass_velocity)].concat()
}

/// Impulse and work of body forces.
pub(crate) fn body_forces(dimension: usize) -> Vec<Column> {
    const MOMENTUM: [&str; 3] = ["body_force_momentum_x", "body_force_momentum_y", "body_force_momentum_z"];
    let momentum = components(MOMENTUM, dimension, |row| row.from_body_forces.momentum);
    [momentum, vec![column("body_force_work", |row, _| row.from_body_forces.work)]].concat()
}

/// Momentum absorbed by each wall: by the axis that it crosses, lower before upper.
const MOMENTUM_OF_WALLS: [[&str; 3]; 6] = [
    ["wall_x_lower_momentum_x", "wall_x_lower_momentum_y", "wall_x_lower_momentum_z"],
    ["wall_x_upper_momentum_x", "wall_x_upper_momentum_y", "wall_x_upper_momentum_z"],
    ["wall_y_lower_momentum_x", "wall_y_lower_momentum_y", "wall_y_lower_momentum_z"],
    ["wall_y_upper_momentum_x", "wall_y_upper_momentum_y", "wall_y_upper_momentum_z"],
    ["wall_z_lower_momentum_x", "wall_z_lower_momentum_y", "wall_z_lower_momentum_z"],
    ["wall_z_upper_momentum_x", "wall_z_upper_momentum_y", "wall_z_upper_momentum_z"],
];

/// Momentum along the flow that boundaries which shear have taken from what crossed them.
pub(crate) const SHEAR_MOMENTUM: Column = column("shear_momentum", |row, _| row.on_walls.sheared);

/// Work that moving walls have done on the particles.
pub(crate) const WALL_WORK: Column = column("wall_work", |row, _| row.on_walls.work);

/// Momentum absorbed by the walls across some axes.
pub(crate) fn on_walls(axes: impl Iterator<Item = usize>, dimension: usize) -> impl Iterator<Item = Column> {
    axes.flat_map(|axis| [2 * axis, 2 * axis + 1]).flat_map(move |wall| {
        let names = MOMENTUM_OF_WALLS[wall].into_iter().take(dimension).enumerate();
        names.map(move |(axis, name)| Column { name, value: Value::OnWall(wall, axis) })
    })
}
