// An ideal gas at the temperature of the scene.
override TEMPERATURE: f32;
override MOLECULAR_MASS: f32;

fn pressure_of(cell: Particle, volume: f32) -> f32 { return mass_of(cell) * (TEMPERATURE / MOLECULAR_MASS) / volume; }
fn energy_density_of(cell: Particle, volume: f32) -> f32 { return 0.0; }
fn temperature_of(cell: Particle) -> f32 { return TEMPERATURE; }
fn noise_temperature(mine: f32, theirs: f32) -> f32 { return TEMPERATURE; }
