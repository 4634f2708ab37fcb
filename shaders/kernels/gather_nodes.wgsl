// The mass of each node, from the cells whose splines reach it.
@group(0) @binding(12) var<storage, read_write> node_masses: array<u32>;

// Rounding alone leaves no less than this.
const LEAST: i32 = -65536;
var<private> gathered: i32;
var<private> least: i32;

fn gather(share: i32) {
    gathered += share;
    least = min(least, min(share, gathered));
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (node >= CELLS_X * CELLS_Y) { return; }
    gather_shares(node % CELLS_X, node / CELLS_X);
    // A cell has too much, or the sum has gone round.
    raise_at(select(0u, FAILURE_CROWDING, least < LEAST), node);
    node_masses[node] = u32(gathered);
}
