// Visits every listed pair, from its owner: first finds those in contact, then computes their impulses and hands them to
// both ends.
@compute @workgroup_size(WORKGROUP)
fn visit_listed_pairs(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { visit_pairs_of(slot); }
    finish_pairs(group, lane);
}

fn visit_pairs_of(slot: u32) {
    prepare_noise();
    let me = stored_particle(slot);
    let count = neighbour_word(slot);
    var kick = Steps(0);
    var sound = true;
    for (var base = 0u; base < count; base += 32u) {
        let end = min(32u, count - base);
        var mask = 0u;
        for (var bit = 0u; bit < end; bit++) {
            let neighbour = neighbour_word((base + bit + 1u) * PARTICLES + slot);
            let d = separation(me.position, stored_position(neighbour & NEIGHBOUR_MASK));
            mask |= select(0u, 1u << bit, dot(d, d) < CUTOFF * CUTOFF);
        }
        while (mask != 0u) {
            let entry = base + firstTrailingBit(mask);
            mask &= mask - 1u;
            let neighbour = neighbour_word((entry + 1u) * PARTICLES + slot);
            let other_slot = neighbour & NEIGHBOUR_MASK;
            let other = stored_particle(other_slot);
            let contact = contact_of(separation(me.position, other.position));
            let c = coefficients_of(species_of(me), species_of(other));
            let root = root_weight(contact.w);
            let repulsion = select(repulsion_impulse(c, 1.0), 0.0, spared(neighbour));
            let push = repulsion * contact.w;
            let magnitude = impulse_of_pair(push, c, contact, root, me, other, entry * PARTICLES + slot);
            let impulse = Steps(round(magnitude * contact.direction));
            sound = sound && is_within(magnitude, IMPULSE_LIMIT);
            kick += impulse;
            add_kick(other_slot, -impulse);
            note_pair(slot, other_slot, repulsion, magnitude, contact);
        }
    }
    add_kick(slot, kick);
    raise(select(FAILURE_IMPULSE, 0u, sound));
}

// Every listed pair repels.
fn spared(neighbour: u32) -> bool { return false; }

// A step without a report.
fn note_pair(slot: u32, other_slot: u32, repulsion: f32, magnitude: f32, contact: Contact) {}
fn finish_pairs(group: u32, lane: u32) {}

// The bath of pairs has no temperature.
fn bath_noise(id: u32, other: u32) -> f32 { return 0.0; }

// The step goes on: what the bath of a pair has become is kept.
fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    let memory = bath - LOSS * bath - c.friction * coupling(contact.w);
    put_pair_memory(place, vec2<u32>(bitcast<u32>(memory), clock_step().x));
}
