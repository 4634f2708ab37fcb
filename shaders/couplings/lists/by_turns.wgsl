// Two lists by turns in the same arrays: a new one is made beside the old one, from which memories are carried over.
override LISTS_ALWAYS: u32 = 0u; // 1 where every step makes a list
override START_STREAM_X: u32;    // key of the random words of new pairs, over all steps
override START_STREAM_Y: u32;

fn current_list() -> u32 {
    if (LISTS_ALWAYS == 1u) { return control.elapsed & 1u; }
    return (atomicLoad(&control.demand) & LIST_SECOND) >> 1u;
}

// Where a particle was stored before the list was made.
fn stored_before(slot: u32) -> u32 { return anchors[slot].w & NEIGHBOUR_MASK; }

// A pair that meets for the first time draws its memory from equilibrium.
fn carry_memories(slot: u32, count: u32) {
    let list = current_list();
    let key = threefry2x32(clock_step(), vec2<u32>(START_STREAM_X, START_STREAM_Y));
    let me = stored_particle(slot);
    let before = stored_before(slot);
    let known = neighbour_word(place_in_list(1u - list, 0u, before));
    for (var entry = 1u; entry <= count; entry++) {
        let other_slot = neighbour_word(place_in_list(list, entry, slot)) & NEIGHBOUR_MASK;
        let other_before = stored_before(other_slot);
        var found = known + 1u;
        for (var old = 1u; old <= known && found > known; old++) {
            if ((neighbour_word(place_in_list(1u - list, old, before)) & NEIGHBOUR_MASK) == other_before) { found = old; }
        }
        var memory: vec2<u32>;
        if (found <= known) {
            memory = pair_memory(place_of_memory(1u - list, found, before));
        } else {
            let other = stored_particle(other_slot);
            let ids = vec2<u32>(min(me.position.w, other.position.w), max(me.position.w, other.position.w));
            let c = coefficients_of(species_of(me), species_of(other));
            let start = PERSISTENCE * c.noise * gaussian_of(pair_words(key, ids));
            memory = vec2<u32>(bitcast<u32>(start), clock_step().x - 1u);
        }
        put_pair_memory(place_of_memory(list, entry, slot), memory);
    }
}
