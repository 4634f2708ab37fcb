//! The columns that tables of energies of several families have.

use super::Observables;

/// A column of the table of energies.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Its value in a row, given the time step.
    pub value: fn(&Observables, f64) -> f64,
}

/// A column.
pub(crate) const fn column(name: &'static str, value: fn(&Observables, f64) -> f64) -> Column {
    Column { name, value }
}

/// Time.
pub(crate) const TIME: Column = column("time", |row, step| row.step as f64 * step);
/// Kinetic energy.
pub(crate) const KINETIC_ENERGY: Column = column("kinetic_energy", |row, _| row.kinetic_energy);
/// Potential energy.
pub(crate) const POTENTIAL_ENERGY: Column = column("potential_energy", |row, _| row.potential_energy);
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
const MOMENTUM: [Column; 3] = [
    column("momentum_x", |row, _| row.momentum[0]),
    column("momentum_y", |row, _| row.momentum[1]),
    column("momentum_z", |row, _| row.momentum[2]),
];
/// The axis of which a column of this name is the component of the total momentum.
pub(crate) fn axis_of_momentum(name: &str) -> Option<usize> {
    MOMENTUM.iter().position(|column| column.name == name)
}

/// Components of the velocity of the centre of mass.
const CENTRE_OF_MASS: [Column; 3] = [
    column("center_of_mass_velocity_x", |row, _| row.centre_of_mass_velocity()[0]),
    column("center_of_mass_velocity_y", |row, _| row.centre_of_mass_velocity()[1]),
    column("center_of_mass_velocity_z", |row, _| row.centre_of_mass_velocity()[2]),
];

/// Total momentum and velocity of the centre of mass.
pub(crate) fn motion(dimension: usize) -> impl Iterator<Item = Column> {
    MOMENTUM.into_iter().take(dimension).chain(CENTRE_OF_MASS.into_iter().take(dimension))
}

/// Momentum that body forces have put in.
const MOMENTUM_PUT_IN: [Column; 3] = [
    column("body_force_momentum_x", |row, _| row.put_in.momentum[0]),
    column("body_force_momentum_y", |row, _| row.put_in.momentum[1]),
    column("body_force_momentum_z", |row, _| row.put_in.momentum[2]),
];

/// Momentum and work that body forces have put in.
pub(crate) fn put_in(dimension: usize) -> impl Iterator<Item = Column> {
    let work = column("body_force_work", |row, _| row.put_in.work);
    MOMENTUM_PUT_IN.into_iter().take(dimension).chain([work])
}

/// Momentum that each wall has taken up: by the axis that it crosses, lower before upper.
const MOMENTUM_OF_WALLS: [[Column; 3]; 6] = [
    [
        column("wall_x_lower_momentum_x", |row, _| row.on_walls.momentum[0][0]),
        column("wall_x_lower_momentum_y", |row, _| row.on_walls.momentum[0][1]),
        column("wall_x_lower_momentum_z", |row, _| row.on_walls.momentum[0][2]),
    ],
    [
        column("wall_x_upper_momentum_x", |row, _| row.on_walls.momentum[1][0]),
        column("wall_x_upper_momentum_y", |row, _| row.on_walls.momentum[1][1]),
        column("wall_x_upper_momentum_z", |row, _| row.on_walls.momentum[1][2]),
    ],
    [
        column("wall_y_lower_momentum_x", |row, _| row.on_walls.momentum[2][0]),
        column("wall_y_lower_momentum_y", |row, _| row.on_walls.momentum[2][1]),
        column("wall_y_lower_momentum_z", |row, _| row.on_walls.momentum[2][2]),
    ],
    [
        column("wall_y_upper_momentum_x", |row, _| row.on_walls.momentum[3][0]),
        column("wall_y_upper_momentum_y", |row, _| row.on_walls.momentum[3][1]),
        column("wall_y_upper_momentum_z", |row, _| row.on_walls.momentum[3][2]),
    ],
    [
        column("wall_z_lower_momentum_x", |row, _| row.on_walls.momentum[4][0]),
        column("wall_z_lower_momentum_y", |row, _| row.on_walls.momentum[4][1]),
        column("wall_z_lower_momentum_z", |row, _| row.on_walls.momentum[4][2]),
    ],
    [
        column("wall_z_upper_momentum_x", |row, _| row.on_walls.momentum[5][0]),
        column("wall_z_upper_momentum_y", |row, _| row.on_walls.momentum[5][1]),
        column("wall_z_upper_momentum_z", |row, _| row.on_walls.momentum[5][2]),
    ],
];

/// Momentum along the flow that boundaries which shear have taken from what crossed them.
pub(crate) const SHEAR_MOMENTUM: Column = column("shear_momentum", |row, _| row.on_walls.sheared);

/// Work that moving walls have done on the particles.
pub(crate) const WALL_WORK: Column = column("wall_work", |row, _| row.on_walls.work);

/// Momentum that the walls across some axes have taken up.
pub(crate) fn on_walls(axes: impl Iterator<Item = usize>, dimension: usize) -> impl Iterator<Item = Column> {
    axes.flat_map(|axis| [2 * axis, 2 * axis + 1])
        .flat_map(move |wall| MOMENTUM_OF_WALLS[wall].into_iter().take(dimension))
}
