// The first half of an iteration: images of the preconditioned residuals, and the sums that it needs.
override PARTICLES: u32;
@group(0) @binding(24) var<storage, read_write> images: array<vec2<f32>>;

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * LANES + lane;
    var products = vec4<f32>(0.0);
    if (slot < PARTICLES) {
        let mine = searches[slot];
        let image = image_of_search(slot, mine);
        images[slot] = image;
        products = products_of(slot, mine, image);
    }
    let sum = sum_of_lanes(lane, products);
    // The sum of the right-hand side stays.
    if (lane == 0u && group * LANES < max(PARTICLES, 1u)) { solver.sums[group] = vec4<f32>(sum.xy, solver.sums[group].zw); }
}
