// Makes the new list the one that counts.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let count = next_neighbour_word(slot);
    put_neighbour_word(slot, count);
    for (var entry = 0u; entry < count; entry++) {
        let place = entry * PARTICLES + slot;
        put_neighbour_word(place + PARTICLES, next_neighbour_word(place + PARTICLES));
        put_pair_memory(place, next_pair_memory(place));
    }
}
