// A report of pairs: energy, virials, curvature, and the conservative forces themselves.
fn note_pair(slot: u32, other_slot: u32, repulsion: f32, magnitude: f32, contact: Contact) {
    let push = repulsion * contact.w;
    total_add(1u, sum64_of_f32(magnitude * contact.distance * PAIR_VIRIAL));
    total_add(5u, sum64_of_f32(push * contact.w * PAIR_ENERGY));
    total_add(6u, sum64_of_f32(push * contact.distance * PAIR_VIRIAL));
    // Two particles in the same place exert no force, and have no curvature either.
    let slope = contact.w / max(contact.distance, 1e-6 * CUTOFF);
    let curvature = select(0.0, repulsion * (1.0 / CUTOFF - f32(DIMENSION - 1u) * slope), contact.distance > 0.0);
    total_add(8u, sum64_of_f32(curvature * LAPLACIAN));
    let force = Steps(round(push * contact.direction));
    add_force(slot, force);
    add_force(other_slot, -force);
}
fn finish_pairs(group: u32, lane: u32) { total_reduce(group, lane); }
