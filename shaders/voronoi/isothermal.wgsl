// Cells at the temperature of the scene.

// == voronoi/gas/isothermal
// An ideal gas at the temperature of the scene.
override TEMPERATURE: f32;
override MOLECULAR_MASS: f32;

fn pressure_of(cell: Particle, volume: f32) -> f32 { return mass_of(cell) * (TEMPERATURE / MOLECULAR_MASS) / volume; }
fn energy_density_of(cell: Particle, volume: f32) -> f32 { return 0.0; }
fn temperature_of(cell: Particle) -> f32 { return TEMPERATURE; }
fn noise_temperature(mine: f32, theirs: f32) -> f32 { return TEMPERATURE; }

// == voronoi/gas_report/isothermal
// The free energy of a cell: that of an ideal gas at the temperature of the scene, zero at the mean volume.
override MEAN_VOLUME: f32;

fn observe_gas(cell: Particle, volume: f32) {
    let molecules = mass_of(cell) / MOLECULAR_MASS;
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_signed(-molecules * TEMPERATURE * log(volume / MEAN_VOLUME) * KINETIC));
}
