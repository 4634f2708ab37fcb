// Cells with an energy of their own.

// == voronoi/gas/energy
// An ideal gas in two dimensions whose internal energy is its total energy less the kinetic one.
override ENERGY_UNIT: f32;
override MOLECULAR_MASS: f32;

// A negative energy is left to `apply_exchange` to report; rounding may leave a cold cell with a few units of it.
fn internal_energy_of(cell: Particle) -> f32 {
    let velocity = velocity_of(cell);
    return max(f32(cell.momentum.z) * ENERGY_UNIT - 0.5 * mass_of(cell) * dot(velocity, velocity), 0.0);
}
fn pressure_at(energy: f32, volume: f32) -> f32 { return max(energy, 0.0) / volume; }
fn pressure_of(cell: Particle, volume: f32) -> f32 { return pressure_at(internal_energy_of(cell), volume); }
fn energy_density_of(cell: Particle, volume: f32) -> f32 { return internal_energy_of(cell) / volume; }
fn temperature_of(cell: Particle) -> f32 { return internal_energy_of(cell) * MOLECULAR_MASS / mass_of(cell); }
// The temperature of the noise of a face: the harmonic mean of its sides.
fn noise_temperature(mine: f32, theirs: f32) -> f32 {
    let sum = mine + theirs;
    return select(0.0, 2.0 * mine * (theirs / sum), sum > 0.0);
}

// == voronoi/gas_report/energy
// Internal energy, total energy and temperature of a cell.
fn observe_gas(cell: Particle, volume: f32) {
    total_add(SUM_INTERNAL_ENERGY, sum64_of_f32(internal_energy_of(cell) * KINETIC));
    total_add(SUM_TOTAL_ENERGY, sum64_of_i32(cell.momentum.z));
    total_add(SUM_TEMPERATURE, sum64_of_f32(temperature_of(cell) * KINETIC));
}
