// No smoothing: the depths are the masses.
override NODES: u32;

@group(0) @binding(13) var<storage, read_write> depths: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= NODES) { return; }
    depths[node] = deviation(node);
}
