// What a report of a split step needs of the first of two stages of relaxation: its virial and its part of the forces.
struct Sums { impulse: Steps, virial: Sum64 }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    return Sums(Steps(0), Sum64(0u));
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    // Before the first step there is no relaxation to report.
    let pull = f32(clock_closing()) * relaxation_impulse(c, contact, root, me, other);
    (*sums).impulse += Steps(round(pull * contact.direction));
    (*sums).virial = sum64_add((*sums).virial, sum64_of_f32(0.5 * pull * contact.distance * PAIR_VIRIAL));
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    if (!is_own(me.position)) { return; }
    total_add(SUM_FIRST_STAGE_VIRIAL, reported_virial(me, sums.virial));
    begin_force();
    add_reported_force(momentum_word(sums.impulse, 0));
    store_force(me.position.w);
}
fn pass_finish(group: u32, lane: u32) { reduce_totals(group, lane, SUM_FIRST_STAGE_VIRIAL, SUM_FIRST_STAGE_VIRIAL); }
