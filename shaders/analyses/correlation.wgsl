// The time correlation of a vector of each particle, such as its velocity or the force on it.
override PRODUCT: f32; // a product of two sampled vectors over its quantum

// Sums the products of each particle's vector with what it was when the window began. One invocation a particle, by id; keeps
// `origins`, writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn correlate_vectors(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    var product = Sum64(0u);
    if (is_measured(id)) {
        let now = sampled(id);
        var then = origins[id].xyz;
        if (samples[0].y % WINDOW == 0u) {
            then = now;
            origins[id] = vec4<f32>(now, 0.0);
        }
        product = sum64_of_signed(dot(now, then) * PRODUCT);
    }
    reduce_quantity(group, lane, 0u, product);
}
