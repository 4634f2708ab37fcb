// A report of bonds: energy, virials, curvature, and the conservative forces themselves.
override PAIR_VIRIAL: f32; // virial per impulse and length, over its quantum; an energy likewise
override LAPLACIAN: f32;   // second derivative at both ends per impulse and inverse length, over its quantum

fn note_bond(slot: u32, other_slot: u32, stretch: Stretch, magnitude: f32, contact: Contact) {
    total_add(1u, sum64_of_f32(magnitude * contact.distance * PAIR_VIRIAL));
    total_add(5u, sum64_of_f32(stretch.energy * PAIR_VIRIAL));
    total_add(6u, sum64_of_f32(stretch.force * contact.distance * PAIR_VIRIAL));
    // Two particles in the same place exert no force, and have no curvature across it either.
    let across = select(0.0, f32(DIMENSION - 1u) * stretch.force / contact.distance, contact.distance > 0.0);
    total_add(8u, sum64_of_f32((stretch.curvature - across) * LAPLACIAN));
    let force = Steps(round(stretch.force * contact.direction));
    add_force(slot, force);
    add_force(other_slot, -force);
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }
