// The bath of the mesh: a variable on every node that remembers the changes of its mass; its law is in baths/bath.
override BATH_PERSISTENCE: f32;
override BATH_RESPONSE: f32;    // per unit of integer mass

// Slot mesh/bath_noise: noise of the bath of a node, in its unit.
// Default: off, a bath without a temperature. The plan chooses `gaussian`.
fn prepare_mesh_noise() {}
fn mesh_noise(node: u32) -> f32 { return 0.0; }

// One step of the bath, which then adds to the depth that drives the particles. One invocation a node; reads `node_masses` and
// `depths`, updates `node_bath` and `previous_masses`, writes `surface`.
@compute @workgroup_size(WORKGROUP)
fn step_mesh_bath(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= CELLS_X * CELLS_Y) { return; }
    var s = node_bath[node];
    let mass = node_masses[node];
    // At step 0 the variable keeps its initial value.
    if (clock_closing() == 1) {
        prepare_mesh_noise();
        let change = f32(bitcast<i32>(mass - previous_masses[node]));
        s = advanced_bath(BATH_PERSISTENCE * s, BATH_RESPONSE, change, mesh_noise(node));
        node_bath[node] = s;
        raise(select(FAILURE_IMPULSE, 0u, is_number(s)));
    }
    previous_masses[node] = mass;
    surface[node] = depths[node] + s;
}
