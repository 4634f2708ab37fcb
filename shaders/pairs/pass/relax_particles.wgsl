// Friction and noise on every particle by itself, in the O of a split step: each component of a momentum relaxes as the
// equation of Ornstein and Uhlenbeck has it, however long the step is and however strong the friction,
//
//     p' = c p + sqrt(m kT (1 - c^2)) xi,   c = exp(-gamma dt/m).
//
// `position_response` is 1 - c here, and `position_deviation` the root. Before the first step there is no O.
fn pass_begin(me: Particle) -> Steps {
    prepare_position_noise();
    let species = species_of(me);
    var noise = Vector(0.0);
    for (var axis = 0u; axis < DIMENSION; axis++) { noise[axis] = position_noise(me.position.w, species, axis); }
    let lost = position_response(species) * (Vector(steps_of(me.momentum)) - flow_of_particle(me));
    return clock_closing() * Steps(round(noise - lost));
}
fn pass_end(row: u32, index: u32, me: Particle, impulse: Steps) {
    replace_momentum(index, me, steps_of(me.momentum) + impulse);
    begin_force();
    add_reported_force(momentum_word(impulse, 0));
    store_force(me.position.w);
}
fn pass_finish(group: u32, lane: u32) {}
