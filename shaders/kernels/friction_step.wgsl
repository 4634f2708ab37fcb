// The second half of an iteration: a step along its direction of search.
override PARTICLES: u32;
@group(0) @binding(24) var<storage, read_write> images: array<vec2<f32>>;
@group(0) @binding(25) var<storage, read_write> directions: array<vec4<f32>>; // of search, and its image

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * LANES + lane;
    if (slot >= PARTICLES) { return; }
    directions[slot] = step_along(slot, images[slot], directions[slot]);
}
