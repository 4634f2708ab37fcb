// Carries what the baths of listed pairs remember from one list to the next. Pairs that meet anew remember what the law at
// rest gives them.
override PARTICLES: u32;
override PERSISTENCE: f32;
override START_STREAM_X: u32; // key of the stream over all steps
override START_STREAM_Y: u32;
@group(0) @binding(27) var<storage, read_write> came_from: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let key = threefry2x32(clock_step(), vec2<u32>(START_STREAM_X, START_STREAM_Y));
    let me = particle_at(slot);
    let before = came_from[slot];
    let known = neighbour_word(before);
    let count = next_neighbour_word(slot);
    for (var entry = 0u; entry < count; entry++) {
        let other_slot = next_neighbour_word((entry + 1u) * PARTICLES + slot) & NEIGHBOUR_MASK;
        let other_before = came_from[other_slot];
        var found = known;
        for (var old = 0u; old < known && found == known; old++) {
            if ((neighbour_word((old + 1u) * PARTICLES + before) & NEIGHBOUR_MASK) == other_before) { found = old; }
        }
        var memory: vec2<u32>;
        if (found < known) {
            memory = pair_memory(found * PARTICLES + before);
        } else {
            let other = particle_at(other_slot);
            let ids = vec2<u32>(min(me.position.w, other.position.w), max(me.position.w, other.position.w));
            let c = coefficients_of(species_of(me), species_of(other));
            let start = PERSISTENCE * c.noise * gaussian_of(pair_words(key, ids));
            memory = vec2<u32>(bitcast<u32>(start), clock_step().x - 1u);
        }
        put_next_pair_memory(entry * PARTICLES + slot, memory);
    }
}
