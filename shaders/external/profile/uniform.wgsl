// The same everywhere.
fn external_kick(me: Particle) -> Steps { return external_kick_at(fraction_of(me.position), species_of(me), clock_step().x); }
fn external_kick_at(fraction: Fraction, species: i32, step: u32) -> Steps {
    return impulse_in_step(external_impulse_of(species), step);
}
