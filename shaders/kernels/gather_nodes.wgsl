// The mass of each node, from the cells whose splines reach it.
@group(0) @binding(12) var<storage, read_write> node_masses: array<u32>;
@group(0) @binding(18) var<storage, read_write> contributions: array<i32>; // [node of the cell][cell]

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= CELLS_X * CELLS_Y) { return; }
    let column = node % CELLS_X;
    let row = node / CELLS_X;
    var mass = 0i;
    var least = 0i;
    for (var l = 0u; l < WIDTH; l++) {
        let base = cell_along(row, l, CELLS_Y) * CELLS_X;
        for (var k = 0u; k < WIDTH; k++) {
            let cell = base + cell_along(column, k, CELLS_X);
            let share = contributions[(k * WIDTH + l) * (CELLS_X * CELLS_Y) + cell];
            mass += share;
            least = min(least, min(share, mass));
        }
    }
    // A cell has too much, or the sum has gone round.
    raise_at(select(0u, FAILURE_CROWDING, least < LEAST_MASS), node);
    node_masses[node] = u32(mass);
}
