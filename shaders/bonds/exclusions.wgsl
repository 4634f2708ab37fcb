// Bonds that exclude repulsion: what the passes over pairs add for bonded particles is taken back.
override EXCLUDED: u32; // pairs in `excluded_pairs`, by the ids of both; a pair that is there already names one particle twice

// Takes back the repulsion of one pair: its negative, whose sums a report adds to those of all pairs.
fn visit_excluded(index: u32) {
    let pair = excluded_pairs[index];
    let slot = slots[pair.x];
    let other_slot = slots[pair.y];
    // Who is not known is beyond the cutoff.
    if (!is_known(slot) || !is_known(other_slot)) { return; }
    let me = particle_at(slot);
    let other = particle_at(other_slot);
    let contact = contact_of(separation(me.position, other.position));
    if (!contact.inside || pair.x == pair.y) { return; }
    let repulsion = repulsion_of(coefficients_of(species_of(me), species_of(other)), contact);
    let impulse = Steps(round(repulsion.impulse * contact.direction));
    add_kick(slot, -impulse);
    add_kick(other_slot, impulse);
    note_excluded(Ends(slot, other_slot, me, other), repulsion, contact);
}

// Slot bonds/exclusion_report: `note_excluded` gets each pair and its repulsion, `finish_exclusions` ends the workgroup.
// Default: off, a step without a report. The plan chooses `observed` for reports; of split steps `motion` where the motion is
// measured, and `configuration` half a drift later; for an analysis of the stress `stress`.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {}
fn finish_exclusions(group: u32, lane: u32) {}

// Of several ranks the owner of the first particle counts a pair.
fn is_counted(pair: Ends) -> bool { return is_own(pair.me.position); }
fn note_virial_of_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    let share = mobile_share(pair.me, pair.other);
    total_add(SUM_VIRIAL, sum64_of_signed(-share * repulsion.impulse * contact.distance * PAIR_VIRIAL));
}
fn note_configuration_of_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    let share = mobile_share(pair.me, pair.other);
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_signed(-repulsion.energy * PAIR_ENERGY));
    total_add(SUM_CONSERVATIVE_VIRIAL, sum64_of_signed(-share * repulsion.impulse * contact.distance * PAIR_VIRIAL));
    total_add(SUM_CURVATURE, sum64_of_signed(-share * repulsion.laplacian * LAPLACIAN));
}
// The conservative forces on both, whoever of several ranks counts the pair.
fn gather_force_of_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    let force = Steps(round(repulsion.impulse * contact.direction));
    add_force(pair.slot, held_kick(pair.me, -force));
    add_force(pair.other_slot, held_kick(pair.other, force));
}

// Takes back the repulsion of all pairs that bonds exclude. One invocation a pair; reads `excluded_pairs`, `slots` and particles,
// adds the impulses of half a step to `kicks` of both.
@compute @workgroup_size(WORKGROUP)
fn exclude_repulsion(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let index = group * WORKGROUP + lane;
    if (index < EXCLUDED) { visit_excluded(index); }
    finish_exclusions(group, lane);
}
