// A report of angles: energy, curvature, and the forces themselves. An angle is the same on every scale, and so has no
// virial.
override ANGLE_LAPLACIAN: f32;   // second derivative per impulse and inverse length, over its quantum

fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {
    add_force(corner.slots.x, select(Steps(0), first, corner.mobile.x));
    add_force(corner.slots.y, select(Steps(0), -first - last, corner.mobile.y));
    add_force(corner.slots.z, select(Steps(0), last, corner.mobile.z));
    // The owner of the vertex counts it, if there are several ranks.
    if (!is_own(particle_at(corner.slots.y).position)) { return; }
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_f32(energy_of_angle(stiffness, corner) * PAIR_VIRIAL));
    total_add(SUM_CURVATURE, sum64_of_f32(stiffness * laplacian_of_cosine(corner) * ANGLE_LAPLACIAN));
}
fn finish_angles(group: u32, lane: u32) { total_reduce(group, lane); }
