// A report of bonds: energy, virials, curvature, and the conservative forces themselves.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    total_add(1u, sum64_of_f32(magnitude * contact.distance * PAIR_VIRIAL));
    total_add(5u, sum64_of_f32(stretch.energy * PAIR_VIRIAL));
    total_add(6u, sum64_of_f32(stretch.force * contact.distance * PAIR_VIRIAL));
    // Two particles in the same place exert no force, and have no curvature across it either.
    let across = select(0.0, f32(DIMENSION - 1u) * stretch.force / contact.distance, contact.distance > 0.0);
    let mobile = vec2<f32>(drift_of_end(bond.me), drift_of_end(bond.other)) > vec2<f32>(0.0);
    let ends = select(0.0, 0.5, mobile.x) + select(0.0, 0.5, mobile.y);
    total_add(8u, sum64_of_f32(ends * (stretch.curvature - across) * LAPLACIAN));
    let force = Steps(round(stretch.force * contact.direction));
    add_force(bond.slot, select(Steps(0), force, mobile.x));
    add_force(bond.other_slot, select(Steps(0), -force, mobile.y));
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }
