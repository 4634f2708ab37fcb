// The deviation of a node's mass from the mean, which is what is smoothed; and depths without smoothing.

// The difference of integers is exact, and keeps all digits of a small deviation.
fn deviation_of_node(node: u32) -> f32 { return f32(i32(node_masses[node] - MEAN_MASS)) * MASS_UNIT; }

override NODES: u32;

// No smoothing: the depths are the masses. One invocation a node; reads `node_masses`, writes `depths`.
@compute @workgroup_size(WORKGROUP)
fn find_depths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= NODES) { return; }
    depths[node] = deviation_of_node(node);
}
