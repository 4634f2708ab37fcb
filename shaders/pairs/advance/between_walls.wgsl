// Stores a particle whose drift walls reflect, and counts it: see external/walls. What friction sees of its kick turns with it.
fn store_advanced(row: u32, index: u32, me: Particle, momentum: Steps, kick: Steps, strain: f32) {
    let species = species_of(me);
    is_booked = is_own(me.position);
    let held = held_momentum(me, momentum);
    check_particle(held, species, strain);
    let flight = fly_all(Flight(fraction_of(me.position), held, Steps(1), 1), species);
    failures_of_particles |= select(0u, FAILURE_MOMENTUM, any_beyond(flight.momentum, MOMENTUM_LIMIT));
    let slot = unframed_index(row, index);
    let word = momentum_word(flight.momentum, species);
    store_particle(slot, advanced_particle(position_word(flight.place, me.position.w), word, held_kick(me, flight.turned * kick)));
    put_rank(slot, atomicAdd(&counts[row_of(flight.place) * CELLS_X + column_of(flight.place)], 1u));
}
