// Stores a particle as in `between_walls`, or one that is frozen behind a wall, see external/layers: it keeps the momentum that goes with its
// wall, which takes up what it was given.
fn store_advanced(row: u32, index: u32, me: Particle, momentum: Steps, kick: Steps, strain: f32) {
    let species = species_of(me);
    let place = fraction_of(me.position);
    is_booked = is_own(me.position);
    let held = held_momentum(me, momentum);
    check_particle(held, species, strain);
    let flight = fly_all(Flight(place, held, Steps(1), 1), species);
    failures_of_particles |= select(0u, FAILURE_MOMENTUM, any_beyond(flight.momentum, MOMENTUM_LIMIT));
    let slot = unframed_index(row, index);
    let word = momentum_word(flight.momentum, species);
    let seen = select(flight.turned * kick, Steps(0), is_behind(place));
    store_particle(slot, advanced_particle(position_word(flight.place, me.position.w), word, seen));
    put_rank(slot, atomicAdd(&counts[row_of(flight.place) * CELLS_X + column_of(flight.place)], 1u));
}
