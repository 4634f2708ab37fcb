// Stores a particle that may have crossed a boundary that shears, and counts it: see external/shear.
fn store_advanced(row: u32, index: u32, me: Particle, momentum: Steps, kick: Steps, strain: f32) {
    let species = species_of(me);
    check_particle(momentum, species, strain);
    is_booked = is_own(me.position);
    let flight = drift_through_all(ShearedFlight(fraction_of(me.position), momentum), species);
    failures_of_particles |= select(0u, FAILURE_MOMENTUM, any_beyond(flight.momentum, MOMENTUM_LIMIT));
    let slot = unframed_index(row, index);
    let word = momentum_word(flight.momentum, species);
    store_particle(slot, advanced_particle(position_word(flight.place, me.position.w), word, kick));
    put_rank(slot, atomicAdd(&counts[row_of(flight.place) * CELLS_X + column_of(flight.place)], 1u));
}
