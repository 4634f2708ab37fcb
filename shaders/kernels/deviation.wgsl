// The deviation of the depth from its mean, where it is not smoothed.
override NODES: u32;
override MEAN_MASS: u32;
override MASS_UNIT: f32;
@group(0) @binding(12) var<storage, read_write> node_masses: array<u32>;
@group(0) @binding(13) var<storage, read_write> depths: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (node < NODES) { depths[node] = MASS_UNIT * f32(bitcast<i32>(node_masses[node] - MEAN_MASS)); }
}
