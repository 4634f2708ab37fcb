// The configuration at the report of a split step, half a drift after the relaxation: there positions are
// distributed most accurately, and there the symmetric step begins and ends.
fn pass_begin(me: Particle) -> PairSums { return no_pairs(); }
fn pass_pair(sums: ptr<function, PairSums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside) { return; }
    let c = coefficients_of(species_of(me), species_of(other));
    observe_conservative(sums, repulsion_of(c, contact), contact);
}
fn pass_end(row: u32, index: u32, me: Particle, sums: PairSums) {
    // All are stored: they go on from here.
    report_particle(row, index, me);
    let bonded = take_gathered_kick(index);
    if (is_own(me.position)) { report_configuration(me, sums, bonded); }
}
fn pass_finish(group: u32, lane: u32) { reduce_configuration(group, lane); }
