// First iteration: from x_0 = 0 to x_1 = b/θ.
@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node == 0u) { iteration.done[0] = 1u; }
    if (node >= NODES_X * NODES_Y) { return; }
    waves[node] = 0.0;
    waves_next[node] = given(node) * INVERSE_CENTRE;
}
