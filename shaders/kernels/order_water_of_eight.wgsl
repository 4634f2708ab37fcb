// Finds every particle its number in the order of cells, in any order within a cell: what is made of them are sums of integers. The
// lanes of a subgroup of eight with the same cell, which most have, take their numbers with one addition: software adapters add
// lane by lane.
override PARTICLES: u32;
@group(0) @binding(3) var<storage, read_write> cells: array<atomic<u32>>; // where each cell begins, then where it ends
const NO_CELL: u32 = 0xffffffffu;

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
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32, @builtin(subgroup_invocation_id) lane_of_eight: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    // All lanes stay to the end, as all are asked for their cells.
    let inside = index < PARTICLES;
    let cell = cell_of(stored_position(min(index, max(PARTICLES, 1u) - 1u)));
    let number = taken_number(select(NO_CELL, cell, inside), lane_of_eight);
    if (inside) { set_order(number, index); }
}
