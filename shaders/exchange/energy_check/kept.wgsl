// A negative internal energy is a failure, beyond what rounding takes from a cold cell.
override ENERGY_SLACK: f32; // of rounding

fn check_energy(cell: Particle) {
    let velocity = velocity_of(cell);
    let kinetic = 0.5 * mass_of(cell) * dot(velocity, velocity);
    let left = f32(cell.momentum.z) * ENERGY_UNIT - kinetic + 2.5e-4 * kinetic + ENERGY_SLACK;
    raise_at(select(FAILURE_ENERGY, 0u, is_number(left) && left >= 0.0), cell.position.w);
    raise(select(0u, FAILURE_MOMENTUM, any_beyond(Steps(cell.momentum.z), UNITS_LIMIT)));
}
