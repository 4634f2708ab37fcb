// Finds every particle its number in the order of cells, in any order within a cell: what is made of them are sums of integers.
override PARTICLES: u32;
@group(0) @binding(3) var<storage, read_write> cells: array<atomic<u32>>; // where each cell begins, then where it ends

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    set_order(atomicAdd(&cells[cell_of(stored_position(index))], 1u), index);
}
