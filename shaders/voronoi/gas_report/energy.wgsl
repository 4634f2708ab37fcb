// Internal energy, total energy and temperature of a cell.
fn observe_gas(cell: Particle, volume: f32) {
    total_add(SUM_INTERNAL_ENERGY, sum64_of_f32(internal_energy_of(cell) * KINETIC));
    total_add(SUM_TOTAL_ENERGY, sum64_of_i32(cell.momentum.z));
    total_add(SUM_TEMPERATURE, sum64_of_f32(temperature_of(cell) * KINETIC));
}
