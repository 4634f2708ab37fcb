// The stress at the report of a leapfrog step: of the impulses of the half kick that closes it.
fn pass_begin(me: Particle) -> PairStresses {
    prepare_pair_noise();
    return no_pair_stresses();
}
fn pass_pair(sums: ptr<function, PairStresses>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(species_of(me), species_of(other));
    let push = repulsion_impulse(c, contact.w);
    let friction = impulse_without_memory(0.0, c, contact, root_weight(contact.w), me, other);
    add_pair_stress(sums, push, friction, contact);
}
fn pass_end(row: u32, index: u32, me: Particle, sums: PairStresses) { keep_pair_stresses(me.position.w, sums); }
fn pass_finish(group: u32, lane: u32) {}
