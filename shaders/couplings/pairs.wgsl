// Listed pairs: each is visited once, by its owner, and its impulses are opposite at its ends.
//
// Slot baths/pairs: `impulse_of_pair` gives the impulse of half a step along the line of centres, positive apart, from
// `push` (the repulsion) and the bath; `place` is where the pair is listed. Even under exchange. Variants white, memory; the
// plan follows the scene. No default. The law itself is in pairs/law.

// Visits the pairs that a particle owns: first finds those in contact, then computes their impulses.
fn visit_pairs_of(slot: u32) {
    prepare_pair_noise();
    let me = stored_particle(slot);
    begin_visit(0u, me);
    let list = current_list();
    let count = neighbour_word(place_in_list(list, 0u, slot));
    var kick = Steps(0);
    var sound = true;
    for (var base = 0u; base < count; base += 32u) {
        let end = min(32u, count - base);
        var mask = 0u;
        for (var bit = 0u; bit < end; bit++) {
            let neighbour = neighbour_word(place_in_list(list, base + bit + 1u, slot));
            let d = separation(me.position, stored_position(neighbour & NEIGHBOUR_MASK));
            mask |= select(0u, 1u << bit, dot(d, d) < CUTOFF * CUTOFF);
        }
        // Ends: every turn clears a bit.
        while (mask != 0u) {
            let entry = base + firstTrailingBit(mask) + 1u;
            mask &= mask - 1u;
            let neighbour = neighbour_word(place_in_list(list, entry, slot));
            let other_slot = neighbour & NEIGHBOUR_MASK;
            let other = stored_particle(other_slot);
            let contact = contact_of(separation(me.position, other.position));
            let c = unless_excluded(neighbour, coefficients_of(species_of(me), species_of(other)));
            let root = root_weight(contact.w);
            let push = repulsion_impulse(c, contact.w);
            let magnitude = impulse_of_pair(push, c, contact, root, me, other, place_of_memory(list, entry, slot));
            let impulse = Steps(round(magnitude * contact.direction));
            sound = sound && is_within(magnitude, IMPULSE_LIMIT);
            kick += impulse;
            add_kick(other_slot, -impulse);
            note_pair(Ends(slot, other_slot, me, other), c, magnitude, contact);
        }
    }
    add_kick(slot, kick);
    raise(select(FAILURE_IMPULSE, 0u, sound));
}

// The coefficients of a listed pair, without repulsion where it is excluded: see couplings/list.
fn unless_excluded(neighbour: u32, c: Coefficients) -> Coefficients {
    if (EXCLUSIONS == 0u) { return c; }
    return Coefficients(select(c.repulsion, 0.0, (neighbour & ~NEIGHBOUR_MASK) != 0u), c.friction, c.noise);
}

// Slot couplings/pair_report: `note_pair` gets each pair with its coefficients and the impulse of all forces, `finish_pairs` ends the
// workgroup. Default: off, a step without a report. The plan chooses `observed` for reports,
// `stress` for an analysis of the stress.
fn note_pair(pair: Ends, c: Coefficients, magnitude: f32, contact: Contact) {}
fn finish_pairs(group: u32, lane: u32) {}

// Slot baths/pair_report: what is done with the new value of a bath.
// Default: kept for the next step. The plan chooses `observed` for reports.
fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    let memory = kept_of_bath(bath, LOSS) - c.friction * coupling(contact.w);
    put_pair_memory(place, vec2<u32>(bitcast<u32>(memory), clock_step().x));
}

// Adds the impulses of every listed pair. One invocation a stored particle, for the pairs that it owns; reads `neighbours` and
// particles, adds the impulses of half a step to `kicks` of both ends.
@compute @workgroup_size(WORKGROUP)
fn visit_listed_pairs(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { visit_pairs_of(slot); }
    finish_pairs(group, lane);
}
