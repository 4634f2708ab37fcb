// Makes the new list the one that counts.
override PARTICLES: u32;
@group(0) @binding(23) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(24) var<storage, read_write> memories: array<vec2<u32>>;
@group(0) @binding(25) var<storage, read_write> neighbours_next: array<u32>;
@group(0) @binding(26) var<storage, read_write> memories_next: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let count = neighbours_next[slot];
    neighbours[slot] = count;
    for (var entry = 0u; entry < count; entry++) {
        let place = entry * PARTICLES + slot;
        neighbours[place + PARTICLES] = neighbours_next[place + PARTICLES];
        memories[place] = memories_next[place];
    }
}
