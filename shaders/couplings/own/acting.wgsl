// Baths on coordinates and a random force: slots baths/positions and baths/coloured_noise, see couplings/own.
var<private> observed_bath: Vector; // of the particle that is reported

fn advance_own(me: Particle) -> OwnImpulses {
    prepare_position_noise();
    let id = me.position.w;
    let noise = advance_hold(id);
    let bath = position_bath(me, species_of(me));
    keep_position_bath(id, bath);
    return OwnImpulses(own_impulse(bath), held_kick(me, noise.closing), held_kick(me, noise.opening));
}
fn observe_own(me: Particle) -> OwnImpulses {
    prepare_position_noise();
    let species = species_of(me);
    observed_bath = position_bath(me, species);
    note_position_bath(species, observed_bath);
    return OwnImpulses(own_impulse(observed_bath), held_kick(me, closing_of_hold(me.position.w)), Steps(0));
}
fn own_impulse(bath: Vector) -> Steps {
    let impulse = position_impulse(bath);
    failures_of_particles |= select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT));
    return Steps(round(impulse));
}
fn observe_own_products(me: Particle, momentum: Steps) {
    note_bath_products(me.position, species_of(me), observed_bath, Vector(momentum));
}
// A report takes what is in `kicks` twice for the impulse of a whole step: it lacks what the closing half step has
// beyond the opening one.
fn leave_opening(slot: u32, me: Particle, own: OwnImpulses) {
    kicks[slot] = momentum_word(steps_of(kicks[slot]) + own.both + own.opening, 0);
    begin_force();
    add_reported_force(momentum_word(clock_closing() * (own.closing - own.opening), 0));
    store_force(me.position.w);
}
fn observe_advanced_own(me: Particle, momentum: Steps) {
    observed_bath = kept_position_bath(me.position.w);
    note_position_bath(species_of(me), observed_bath);
    observe_own_products(me, momentum);
}
fn finish_own() { raise(failures_of_particles); }
