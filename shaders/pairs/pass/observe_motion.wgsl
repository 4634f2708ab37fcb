// The motion at the report of a split step: momenta after the relaxation, and the virial of all forces.
struct Sums { impulse: Steps, virial: Sum64 }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    begin_force();
    return Sums(Steps(0), Sum64(0u));
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    let push = repulsion_impulse(c, contact.w);
    // Before the first step there is no relaxation to report.
    let pull = f32(clock_closing()) * relaxation_impulse(c, contact, root, me, other);
    let relaxation = Steps(round(pull * contact.direction));
    (*sums).impulse += relaxation;
    // The whole step: two half kicks and the relaxation between them.
    add_reported_force(momentum_word(2 * Steps(round(push * contact.direction)) + relaxation, 0));
    // The two half kicks make one whole, as does the impulse of the relaxation.
    let virial = (push + 0.5 * pull) * contact.distance * PAIR_VIRIAL;
    (*sums).virial = sum64_add((*sums).virial, sum64_of_f32(virial));
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    if (!is_own(me.position)) { return; }
    let momentum = steps_of(me.momentum) + sums.impulse;
    report_motion(me, momentum, sums.virial);
    let kept = reported_motion(me, momentum);
    observe_advanced_own(me, kept);
    store_momentum(me.position.w, momentum_word(kept, species_of(me)));
    add_reported_force(momentum_word(2 * (gathered_kick(index) + external_kick(me)), 0));
    store_force(me.position.w);
}
fn pass_finish(group: u32, lane: u32) {
    reduce_motion(group, lane);
    reduce_baths(group, lane);
    reduce_absorbed(group, lane);
}
