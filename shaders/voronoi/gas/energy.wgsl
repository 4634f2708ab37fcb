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
