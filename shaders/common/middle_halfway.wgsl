// The pressure halfway through an exchange of heat.
fn middle_pressure(cell: Particle, pressure: f32, volume: f32, heat: f32) -> f32 {
    return pressure_at(internal_energy_of(cell) + 0.5 * heat, volume);
}
