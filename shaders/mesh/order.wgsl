// Counts freshly uploaded particles in the cells of the mesh; every later step keeps count as it advances.
@compute @workgroup_size(WORKGROUP)
fn bin_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    atomicAdd(&counts[cell_of(stored_water_position(index))], 1u);
}

// Finds every particle its number in the order of cells, in any order within a cell: what is made of them are sums of integers. The
// lanes of a subgroup of eight with the same cell, which most have, take their numbers with one addition: software adapters add
// lane by lane.
// Finds every particle its number in the order of cells, in any order within a cell: what is made of them are sums of integers.
var<storage, read_write> cells: array<u32>; // where each cell begins, then where it ends

@compute @workgroup_size(WORKGROUP)
fn order_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    set_order(atomicAdd(&cells[cell_of(stored_water_position(index))], 1u), index);
}


fn taken_number(cell: u32, lane: u32) -> u32 {
    var first_lane = lane;
    var before = 0u; // lanes with the same cell
    var together = 1u;
    for (var step = 1u; step < 8u; step++) {
        let other = (lane + step) & 7u;
        let same = subgroupShuffle(cell, other) == cell;
        first_lane = min(first_lane, select(lane, other, same));
        before += select(0u, 1u, same && other < lane);
        together += select(0u, 1u, same);
    }
    var number = 0u;
    if (first_lane == lane && cell != NO_CELL) { number = atomicAdd(&cells[cell], together); }
    return subgroupShuffle(number, first_lane) + before;
}

@compute @workgroup_size(WORKGROUP)
fn order_water_of_eight(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32, @builtin(subgroup_invocation_id) lane_of_eight: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    // All lanes stay to the end, as all are asked for their cells.
    let inside = index < PARTICLES;
    let cell = cell_of(stored_water_position(min(index, max(PARTICLES, 1u) - 1u)));
    let number = taken_number(select(NO_CELL, cell, inside), lane_of_eight);
    if (inside) { set_order(number, index); }
}


// Copies the particles in the order of cells.
@compute @workgroup_size(WORKGROUP)
fn tidy_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (number >= PARTICLES) { return; }
    copy_particle(in_order(number), number);
}


// Takes the particles as they were copied in the order of cells.
@compute @workgroup_size(WORKGROUP)
fn keep_tidied_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (number >= PARTICLES) { return; }
    copy_particle(number, number);
    set_order(number, number);
}
