// A step along a direction of search.
override PARTICLES: u32;
@group(0) @binding(21) var<storage, read_write> estimates: array<vec4<f32>>;       // W, residual
@group(0) @binding(22) var<storage, read_write> preconditioners: array<vec4<f32>>; // inverse of a cell's block; 2M
@group(0) @binding(23) var<storage, read_write> searches: array<vec4<f32>>;        // preconditioned residual; place
@group(0) @binding(24) var<storage, read_write> images: array<vec2<f32>>;
@group(0) @binding(25) var<storage, read_write> directions: array<vec4<f32>>;      // of search, and its image

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup, workgroups) * LANES + lane;
    if (slot >= PARTICLES) { return; }
    let search = searches[slot];
    var direction = vec4<f32>(search.xy, images[slot]);
    // What is left of an earlier step need not be a number.
    if (solver.turn != 0.0) { direction += solver.turn * directions[slot]; }
    directions[slot] = direction;
    let length = vec4<f32>(vec2<f32>(solver.step_length), vec2<f32>(-solver.step_length));
    let estimate = estimates[slot] + length * direction;
    estimates[slot] = estimate;
    searches[slot] = vec4<f32>(preconditioned(preconditioners[slot].xyz, estimate.zw), search.zw);
}
