// The report of a leapfrog step: positions are at the step, momenta half a step behind until the closing half kick.
struct Sums { kick: Steps, pairs: PairSums }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    begin_force();
    return Sums(Steps(0), no_pairs());
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    let repulsion = repulsion_of(c, contact);
    let magnitude = impulse_without_memory(repulsion.impulse, c, contact, root, me, other);
    (*sums).kick += Steps(round(magnitude * contact.direction));
    var pairs = (*sums).pairs;
    observe_conservative(&pairs, repulsion, contact);
    observe_virial(&pairs, magnitude, PAIR_VIRIAL, contact);
    (*sums).pairs = pairs;
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    let bonded = take_gathered_kick(index);
    let conservative = conservative_kick(index, bonded);
    if (!is_own(me.position)) { return; }
    report_configuration(me, sums.pairs, conservative);
    let own = observe_own(me);
    let kick = sums.kick + bonded + external_kick(me) + own.both + own.closing;
    let momentum = steps_of(me.momentum) + clock_closing() * kick;
    report_motion(me, momentum, sums.pairs.virial);
    add_reported_force(momentum_word(kick, 0));
    store_force(me.position.w);
    let kept = reported_motion(me, momentum);
    observe_own_products(me, kept);
    let word = momentum_word(kept, species_of(me));
    report_particle(row, index, advanced_particle(me.position, word, Steps(0)));
}
fn pass_finish(group: u32, lane: u32) {
    total_reduce(group, lane);
    reduce_absorbed(group, lane);
}
