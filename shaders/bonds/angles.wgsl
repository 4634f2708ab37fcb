// Angles between three particles of a chain: V = k (1 + cos), least where the chain is straight.
override ANGLES: u32;
override FIRST_ANGLE: u32;

// `angles` holds a word for each species, 1 if it can move; then for each angle the ids of three particles, the vertex second, and
// the bits of the stiffness: an impulse of half a step times a length.
struct Corner {
    slots: vec3<u32>,
    mobile: vec3<bool>,
    cosine: f32,
    opening: f32,                // 1 + cosine
    inverse_lengths: vec2<f32>, // of the arms
}

fn is_mobile(particle: Particle) -> bool { return angles[species_of(particle)].x == 1u; }

// Adds the impulses of one angle.
fn visit_angle(angle: u32) {
    let word = angles[FIRST_ANGLE + angle];
    let ends = vec3<u32>(slots[word.x], slots[word.y], slots[word.z]);
    if (!are_known(ends)) { return; }
    let stiffness = bitcast<f32>(word.w);
    let first_end = particle_at(ends.x);
    let middle = particle_at(ends.y);
    let last_end = particle_at(ends.z);
    let first_arm = contact_of(separation(first_end.position, middle.position));
    let last_arm = contact_of(separation(last_end.position, middle.position));
    // Without an arm there is no angle, and no force.
    if (first_arm.distance == 0.0 || last_arm.distance == 0.0) { return; }
    // Half of the squared sum of both directions: no cancellation where the chain is nearly straight.
    let sum = first_arm.direction + last_arm.direction;
    let opening = 0.5 * dot(sum, sum);
    let mobile = vec3<bool>(is_mobile(first_end), is_mobile(middle), is_mobile(last_end));
    let lengths = vec2<f32>(first_arm.distance, last_arm.distance);
    let corner = Corner(ends, mobile, opening - 1.0, opening, 1.0 / lengths);
    // The part of the other direction across the own: other - cosine own = sum - opening own.
    let first_pull = -stiffness * corner.inverse_lengths.x * (sum - opening * first_arm.direction);
    let last_pull = -stiffness * corner.inverse_lengths.y * (sum - opening * last_arm.direction);
    let first = Steps(round(first_pull));
    let last = Steps(round(last_pull));
    add_kick(ends.x, first);
    add_kick(ends.y, -first - last);
    add_kick(ends.z, last);
    note_angle(stiffness, corner, first, last);
    let sound = all_within(first_pull, IMPULSE_LIMIT) && all_within(last_pull, IMPULSE_LIMIT);
    raise(select(FAILURE_IMPULSE, 0u, sound));
}

// The energy of an angle, an impulse times a length.
fn energy_of_angle(stiffness: f32, corner: Corner) -> f32 { return stiffness * corner.opening; }
// The second derivatives of the cosine by the positions of the particles that can move. As a function of the direction of one arm the
// cosine is a spherical harmonic of degree 1; the middle moves both.
fn laplacian_of_cosine(corner: Corner) -> f32 {
    let inverse = corner.inverse_lengths;
    let alone = -f32(DIMENSION - 1u) * corner.cosine * inverse * inverse;
    let both = (f32(DIMENSION) - 2.0 + corner.cosine * corner.cosine) * inverse.x * inverse.y;
    return select(0.0, alone.x, corner.mobile.x) + select(0.0, alone.y, corner.mobile.z)
        + select(0.0, alone.x + alone.y + 2.0 * both, corner.mobile.y);
}

// Slot bonds/angle_report: `note_angle` gets each angle and the impulses on its ends, `finish_angles` ends the workgroup.
// Default: off, a step without a report. The plan chooses `observed` for reports,
// `stress` for an analysis of the stress.
fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {}
fn finish_angles(group: u32, lane: u32) {}

// Adds the impulses of every angle. One invocation an angle; reads `angles`, `slots` and particles, adds the impulses of half a
// step to `kicks` of all three.
@compute @workgroup_size(WORKGROUP)
fn bend_angles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let angle = group * WORKGROUP + lane;
    if (angle < ANGLES) { visit_angle(angle); }
    finish_angles(group, lane);
}
