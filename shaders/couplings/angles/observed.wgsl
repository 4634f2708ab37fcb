// A report of angles: energy, curvature, and the forces themselves. An angle is the same on every scale, and so has no
// virial.
override ANGLE_LAPLACIAN: f32;   // second derivative per impulse and inverse length, over its quantum

fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {
    total_add(5u, sum64_of_f32(stiffness * corner.opening * PAIR_VIRIAL));
    // As a function of the direction of one arm the cosine is a spherical harmonic of degree 1; the middle moves both.
    let inverse = corner.inverse_lengths;
    let alone = -f32(DIMENSION - 1u) * corner.cosine * inverse * inverse;
    let both = (f32(DIMENSION) - 2.0 + corner.cosine * corner.cosine) * inverse.x * inverse.y;
    let laplacian = select(0.0, alone.x, corner.mobile.x) + select(0.0, alone.y, corner.mobile.z)
        + select(0.0, alone.x + alone.y + 2.0 * both, corner.mobile.y);
    total_add(8u, sum64_of_f32(stiffness * laplacian * ANGLE_LAPLACIAN));
    add_force(corner.slots.x, select(Steps(0), first, corner.mobile.x));
    add_force(corner.slots.y, select(Steps(0), -first - last, corner.mobile.y));
    add_force(corner.slots.z, select(Steps(0), last, corner.mobile.z));
}
fn finish_angles(group: u32, lane: u32) { total_reduce(group, lane); }
