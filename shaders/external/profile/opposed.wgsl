// In the second half of the box the opposite of that in the first.
fn external_kick(me: Particle) -> Steps { return external_kick_at(fraction_of(me.position), species_of(me), clock_step().x); }
fn external_kick_at(fraction: Fraction, species: i32, step: u32) -> Steps {
    let kick = impulse_in_step(external_impulse_of(species), step);
    return select(kick, -kick, fraction[FORCE_AXIS] >= 0x80000000u);
}
