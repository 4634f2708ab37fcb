// The free energy of a cell: that of an ideal gas at the temperature of the scene, zero at the mean volume.
override MEAN_VOLUME: f32;

fn observe_gas(cell: Particle, volume: f32) {
    let molecules = mass_of(cell) / MOLECULAR_MASS;
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_signed(-molecules * TEMPERATURE * log(volume / MEAN_VOLUME) * KINETIC));
}
