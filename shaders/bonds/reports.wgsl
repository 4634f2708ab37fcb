// Contributions of bonds, angles, tethers and excluded pairs to reports.

// == bonds/bond_report/observed
// A report of bonds: motion and configuration.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    gather_force_of_bond(bond, stretch, contact);
    if (!is_own(bond.me.position)) { return; }
    note_virial_of_bond(bond, magnitude, contact);
    note_configuration_of_bond(bond, stretch, contact);
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/bond_report/configuration
// A report of bonds where a split step measures the configuration.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    if (is_own(bond.me.position)) { note_configuration_of_bond(bond, stretch, contact); }
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/bond_report/motion
// A report of bonds where a split step measures the motion: the virial of all forces.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    if (is_own(bond.me.position)) { note_virial_of_bond(bond, magnitude, contact); }
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/bond_report/stress
// The stress of bonds at a report.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    share_stress(bond.me.position.w, bond.other.position.w, stretch.force, magnitude - stretch.force, contact);
}
fn finish_bonds(group: u32, lane: u32) {}

// == bonds/angle_report/observed
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

// == bonds/angle_report/stress
// The stress of angles at a report: of both arms from the vertex, whose traces cancel. The sum of r f over both is symmetric, because an
// angle does not change when it is turned.
fn note_angle(stiffness: f32, corner: Corner, first: Steps, last: Steps) {
    let middle = particle_at(corner.slots.y);
    let first_arm = separation(particle_at(corner.slots.x).position, middle.position);
    let last_arm = separation(particle_at(corner.slots.z).position, middle.position);
    let a = padded(first_arm);
    let b = padded(last_arm);
    let f = padded(Vector(first));
    let g = padded(Vector(last));
    // All of the angle, where a pair counts half.
    let diagonal = 2.0 * STRESS * (a * f + b * g);
    let across = STRESS * (a.xxy * f.yzz + a.yzz * f.xxy + b.xxy * g.yzz + b.yzz * g.xxy);
    add_stress(middle.position.w, CONSERVATIVE, Stress(vec3<i32>(round(diagonal)), vec3<i32>(round(across))));
}
fn finish_angles(group: u32, lane: u32) {}

fn padded(vector: Vector) -> vec3<f32> {
    let words = words_of_force(vector);
    return vec3<f32>(words[0], words[1], words[2]);
}

// == bonds/tether_report/observed
// A report of tethers: energy, curvature, force. They are tied to points fixed in space and add nothing to a pressure.
fn note_tether(slot: u32, me: Particle, length: Vector) {
    total_add(SUM_POTENTIAL_ENERGY, sum64_of_f32(energy_of_tether(length)));
    total_add(SUM_CURVATURE, sum64_of_f32(mobile_part(me) * TETHER_LAPLACIAN));
    add_force(slot, Steps(round(mobile_part(me) * impulse_of_tether(length))));
}
fn finish_tethers(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/exclusion_report/observed
// A report of excluded pairs: motion and configuration.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    gather_force_of_excluded(pair, repulsion, contact);
    if (!is_counted(pair)) { return; }
    note_virial_of_excluded(pair, repulsion, contact);
    note_configuration_of_excluded(pair, repulsion, contact);
}
fn finish_exclusions(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/exclusion_report/configuration
// A report of excluded pairs where a split step measures the configuration.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    if (is_counted(pair)) { note_configuration_of_excluded(pair, repulsion, contact); }
}
fn finish_exclusions(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/exclusion_report/motion
// A report of excluded pairs where a split step measures the motion: the virial of all forces.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    if (is_counted(pair)) { note_virial_of_excluded(pair, repulsion, contact); }
}
fn finish_exclusions(group: u32, lane: u32) { total_reduce(group, lane); }

// == bonds/exclusion_report/stress
// The stress of excluded pairs at a report, which is taken back.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    share_stress(pair.me.position.w, pair.other.position.w, -repulsion.impulse, 0.0, contact);
}
fn finish_exclusions(group: u32, lane: u32) {}
