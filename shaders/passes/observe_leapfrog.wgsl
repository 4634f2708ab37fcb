// The report of a leapfrog step: positions are at the step, momenta half a step behind until the closing half kick.
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>;

struct Sums { kick: Steps, pairs: PairSums }

fn pass_begin(me: Particle) -> Sums {
    prepare_noise();
    return Sums(Steps(0), no_pairs());
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = sorted[other_index];
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(me.momentum.w, other.momentum.w);
    let root = root_weight(contact.w);
    let repulsion = repulsion_impulse(c, 1.0);
    let magnitude = repulsion_impulse(c, contact.w) + friction_impulse(c, contact, root, me, other)
        + random_impulse(c, root, me, other);
    (*sums).kick += Steps(round(magnitude * contact.direction));
    var pairs = (*sums).pairs;
    observe_conservative(&pairs, repulsion, contact);
    observe_virial(&pairs, magnitude, PAIR_VIRIAL, contact);
    (*sums).pairs = pairs;
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    observe_particle(me, steps_of(me.momentum) + control.closing * sums.kick, sums.pairs);
}
fn pass_finish(group: u32, lane: u32) {
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        reduce_quantity(group, lane, quantity, totals[quantity]);
    }
}
