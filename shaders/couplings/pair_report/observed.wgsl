// A report of pairs: energy, virials, curvature, and the conservative forces themselves.
fn note_pair(slot: u32, other_slot: u32, c: Coefficients, magnitude: f32, contact: Contact) {
    let repulsion = repulsion_of(c, contact);
    total_add(1u, sum64_of_f32(magnitude * contact.distance * PAIR_VIRIAL));
    total_add(5u, sum64_of_f32(repulsion.energy * PAIR_ENERGY));
    total_add(6u, sum64_of_f32(repulsion.impulse * contact.distance * PAIR_VIRIAL));
    total_add(8u, sum64_of_f32(repulsion.laplacian * LAPLACIAN));
    let force = Steps(round(repulsion.impulse * contact.direction));
    add_force(slot, force);
    add_force(other_slot, -force);
}
fn finish_pairs(group: u32, lane: u32) { total_reduce(group, lane); }
