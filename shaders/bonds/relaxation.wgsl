// Friction and noise along bonds, in the O of a split step: one bond after the other, each as the equation of Ornstein
// and Uhlenbeck has it, whatever its friction,
//
//     u' = c u + sqrt(kT (1 - c^2)/mu) xi,   c = exp(-gamma dt/mu),
//
// with the velocity u along the bond and the reduced mass mu of its ends. `bonds` has them once more in rounds: those
// of a round share no particle, so that their order does not matter.
override FIRST_RELAXED: u32; // of a round, in `bonds`
override RELAXED: u32;       // bonds of the round
const WHOLLY: f32 = 100.0;   // the rate from which on nothing is left of a velocity

// Relaxes the bonds of a round. One invocation a bond; reads `bonds` and `slots`, updates both ends among the sorted
// particles, and writes `bond_impulses` for reports. One computes the impulse for both ends. Before the first step
// there is no O.
@compute @workgroup_size(WORKGROUP)
fn relax_bonds(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let place = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (place >= RELAXED) { return; }
    prepare_bond_noise();
    // Ids of the ends, the kind, and the number of the bond.
    let word = bonds[FIRST_RELAXED + place];
    let kind = bond_kind(word.z);
    let slot = slots[word.x];
    let other_slot = slots[word.y];
    if (!are_known(vec3<u32>(slot, other_slot, other_slot))) { return; }
    let me = particle_at(slot);
    let other = particle_at(other_slot);
    let contact = contact_of(separation(me.position, other.position));
    check_reach(me.position, other.position, contact.distance);
    let inverse_mass = pair_rate(me, other, 1.0, 0.0, 0.0);
    let rate = min(kind.response * inverse_mass, WHOLLY);
    let lost = rate * relaxed_share(rate); // 1 - c
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let noise = kind.noise * bond_noise(word.w) * sqrt(lost * (2.0 - lost) / inverse_mass);
    let relaxed = noise - lost / inverse_mass * dot(contact.direction, motion);
    // Two held ends have no motion to relax.
    let magnitude = f32(clock_closing()) * select(relaxed, 0.0, inverse_mass == 0.0);
    let impulse = Steps(round(magnitude * contact.direction));
    replace_momentum(slot, me, held_momentum(me, steps_of(me.momentum) + impulse));
    replace_momentum(other_slot, other, held_momentum(other, steps_of(other.momentum) - impulse));
    bond_impulses[word.w] = magnitude;
    raise(select(FAILURE_IMPULSE, 0u, is_within(magnitude, IMPULSE_LIMIT)));
    note_impulse(me.position.w, impulse);
    note_impulse(other.position.w, -impulse);
}

// Leaves an impulse for an analysis of forces, if there is one.
fn note_impulse(id: u32, impulse: Steps) {
    begin_force();
    add_reported_force(momentum_word(impulse, 0));
    store_force(id);
}
