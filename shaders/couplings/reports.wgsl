// Contributions of pairs in a list and of baths with memory to reports.

// == couplings/pair_report/observed
// A report of pairs: energy, virials, curvature, and the conservative forces themselves.
fn note_pair(pair: Ends, c: Coefficients, magnitude: f32, contact: Contact) {
    let repulsion = repulsion_of(c, contact);
    let share = mobile_share(pair.me, pair.other);
    total_add(SUM_VIRIAL, sum64_of_f32(share * magnitude * contact.distance * PAIR_VIRIAL));
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_f32(repulsion.energy * PAIR_ENERGY));
    total_add(SUM_CONSERVATIVE_VIRIAL, sum64_of_f32(share * repulsion.impulse * contact.distance * PAIR_VIRIAL));
    total_add(SUM_CURVATURE, sum64_of_f32(share * repulsion.laplacian * LAPLACIAN));
    let force = Steps(round(repulsion.impulse * contact.direction));
    add_force(pair.slot, held_kick(pair.me, force));
    add_force(pair.other_slot, held_kick(pair.other, -force));
}
fn finish_pairs(group: u32, lane: u32) { total_reduce(group, lane); }

// == couplings/pair_report/stress
// The stress of listed pairs at a report.
fn note_pair(pair: Ends, c: Coefficients, magnitude: f32, contact: Contact) {
    let push = repulsion_of(c, contact).impulse;
    share_stress(pair.me.position.w, pair.other.position.w, push, magnitude - push, contact);
}
fn finish_pairs(group: u32, lane: u32) {}

// == baths/pair_report/observed
// A report reads the baths of pairs in contact and leaves them as they are.
override BATH_ENERGY: f32; // energy per square of a bath with a response of one, over its quantum

fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    report_bath(bath, c.friction, BATH_ENERGY);
}

// == baths/bond_report/observed
// A report reads the baths of bonds and leaves them as they are.
fn note_bond_bath(bond: u32, kind: BondKind, bath: f32) {
    if (kind.remembers) { report_bath(bath, 1.0, kind.bath_energy); }
}
