// A report of angles: energy, curvature, and the forces themselves. An angle is the same on every scale, and so has no
// virial.
override PAIR_VIRIAL: f32;       // energy per impulse and length, over its quantum
override ANGLE_LAPLACIAN: f32;   // second derivative per impulse and inverse length, over its quantum

fn note_angle(slots_of_ends: vec3<u32>, stiffness: f32, corner: Corner, first: Steps, last: Steps) {
    total_add(5u, sum64_of_f32(stiffness * corner.opening * PAIR_VIRIAL));
    // As a function of the direction of one arm the cosine is a spherical harmonic of degree 1; the middle moves both.
    let inverse = corner.inverse_lengths;
    let alone = f32(DIMENSION - 1u) * corner.cosine * dot(inverse, inverse);
    let both = (f32(DIMENSION) - 2.0 + corner.cosine * corner.cosine) * inverse.x * inverse.y;
    total_add(8u, sum64_of_f32(2.0 * stiffness * (both - alone) * ANGLE_LAPLACIAN));
    add_force(slots_of_ends.x, first);
    add_force(slots_of_ends.y, -first - last);
    add_force(slots_of_ends.z, last);
}
fn finish_angles(group: u32, lane: u32) { total_reduce(group, lane); }
