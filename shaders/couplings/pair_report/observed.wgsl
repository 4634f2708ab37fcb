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
