// A sine with a whole number of waves.
override WAVES: u32;

fn external_kick(me: Particle) -> Steps { return external_kick_at(fraction_of(me.position), species_of(me), clock_step().x); }
fn external_kick_at(fraction: Fraction, species: i32, step: u32) -> Steps {
    let angle = fraction[FORCE_AXIS] * WAVES;
    let sine = sine_of_half_turn(angle & 0x7fffffffu);
    let kick = impulse_in_step(part_of_impulse(external_impulse_of(species), sine), step);
    return select(kick, -kick, angle >= 0x80000000u);
}
