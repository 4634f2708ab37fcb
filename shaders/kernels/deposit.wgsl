// Collects the particles of a cell and spreads them over the nodes under its splines.
//
// The moments Σ m xᵃ yᵇ of the cell are integer sums, so that their order does not matter; the masses of the nodes
// follow from them, and what rounding leaves over goes to one node: no mass is lost.

// The most that the integers of a cell hold, and what stands for more: less than nothing, which the nodes notice.
const MOST: f32 = 2.1e9;
const TOO_MUCH: i32 = -1073741824;
@group(0) @binding(18) var<storage, read_write> contributions: array<i32>; // [node of the cell][cell]

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (cell == 0u) { begin_unsorted_step(); }
    if (cell >= CELLS_X * CELLS_Y) { return; }
    collect(cell);
    var moments: Moments;
    var total = 0.0;
    let bin = opened_bin(cell);
    for (var k = 0u; k < bin.count; k++) {
        let particle = stored(place_in(bin, k));
        total += f32(particle.mass);
        add_particle(&moments, particle);
    }
    moments = without_rounding(moments, i32(bin.count));
    hand_out(cell, node_weights(moments), moments[0].x);
    if (total > MOST) {
        contributions[(NODES_BEFORE * WIDTH + NODES_BEFORE) * (CELLS_X * CELLS_Y) + cell] = TOO_MUCH;
    }
}
