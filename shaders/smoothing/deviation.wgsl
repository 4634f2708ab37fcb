// The depth of a node is its mass; what is smoothed is its deviation from the mean.
// The difference of integers is exact, and keeps all digits of a small deviation.
fn deviation(node: u32) -> f32 { return f32(i32(node_masses[node] - MEAN_MASS)) * MASS_UNIT; }

// No smoothing: the depths are the masses.
override NODES: u32;

@compute @workgroup_size(WORKGROUP)
fn find_depths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= NODES) { return; }
    depths[node] = deviation(node);
}
