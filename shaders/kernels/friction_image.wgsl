// The image of the preconditioned residual under the equations, and the sums that an iteration needs.
override PARTICLES: u32;
override VISCOSITY: f32; // times the time step
@group(0) @binding(21) var<storage, read_write> estimates: array<vec4<f32>>;       // W, residual
@group(0) @binding(22) var<storage, read_write> preconditioners: array<vec4<f32>>; // inverse of a cell's block; 2M
@group(0) @binding(23) var<storage, read_write> searches: array<vec4<f32>>;        // preconditioned residual; place
@group(0) @binding(24) var<storage, read_write> images: array<vec2<f32>>;

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup, workgroups);
    let slot = group * LANES + lane;
    var products = vec4<f32>(0.0);
    if (slot < PARTICLES) {
        let mine = searches[slot];
        let image = image_of_search(slot, mine);
        images[slot] = image;
        products = vec4<f32>(dot(estimates[slot].zw, mine.xy), dot(image, mine.xy), 0.0, 0.0);
    }
    let sum = sum_of_lanes(lane, products);
    // The sum of the right-hand side stays.
    if (lane == 0u && group * LANES < max(PARTICLES, 1u)) { solver.sums[group] = vec4<f32>(sum.xy, solver.sums[group].zw); }
}

fn image_of_search(slot: u32, mine: vec4<f32>) -> Vector {
    var image = preconditioners[slot].w * mine.xy;
    let place = bitcast<vec2<u32>>(mine.zw);
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = number * PARTICLES + slot;
        let word = face_words[face];
        let other = neighbour_of(word);
        if (other == slot) { continue; }
        let theirs = searches[other];
        let apart = separation(place, bitcast<vec2<u32>>(theirs.zw), word);
        let square = dot(apart, apart);
        let v = mine.xy - theirs.xy;
        image += VISCOSITY * face_lengths[face] * inverseSqrt(square) * (v + dot(v, apart) / square * apart);
    }
    return image;
}
