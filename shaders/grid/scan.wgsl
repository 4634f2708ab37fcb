// The prefix sum over cells: where each cell's particles begin in the sorted array.
//
// Up to some thousand cells are summed by one workgroup, more by three kernels (src/plan/prefix_sum.rs).

// Particles in the row's cells with its frame (x) and without (y). Also provided by grid/rows/mesh_in_pairs.
fn row_totals(row: u32) -> vec2<u32> {
    let base = row * CELLS_X;
    var total = 0u;
    for (var column = 0u; column < CELLS_X; column++) { total += atomicLoad(&counts[base + column]); }
    let framing = select(0u, atomicLoad(&counts[base]) + atomicLoad(&counts[base + CELLS_X - 1u]), frame() == 1u);
    return vec2<u32>(total + framing, total);
}

// Writes where each cell of the row begins, given the totals of all rows before it. Also provided by grid/rows/mesh_in_pairs.
fn write_row(row: u32, before: vec2<u32>) {
    let base = row * CELLS_X;
    var begin = before.x;
    if (frame() == 1u) {
        put_cell(row * row_width(), begin);
        begin += atomicLoad(&counts[base + CELLS_X - 1u]);
    }
    for (var column = 0u; column < CELLS_X; column++) {
        put_cell(cell_index(row, column), begin);
        begin += atomicLoad(&counts[base + column]);
    }
    if (frame() == 1u) {
        put_cell(cell_index(row, CELLS_X), begin);
        begin += atomicLoad(&counts[base]);
    }
    if (row == rows() - 1u) { put_cell(rows() * row_width(), begin); }
    put_cell(row_offset_index(row), before.y);
}

// Slot grid/scan_width: lanes of the workgroup that sums.
// Default: as many as every adapter has. Plans choose `narrow` where lanes are executed one after the other.
const SCAN_LANES: u32 = 256u;

var<workgroup> scan_lanes: array<vec2<u32>, SCAN_LANES>;

// Slot grid/scan_lanes: an exclusive prefix sum over the lanes of a workgroup, of two sums at once. All lanes call it.
// Default: through workgroup memory. The plan of particles chooses `eight` where the workgroup is a subgroup of eight
// lanes.
fn scan_of_lanes(lane: u32, value: vec2<u32>) -> vec2<u32> {
    scan_lanes[lane] = value;
    workgroupBarrier();
    for (var stride = 1u; stride < SCAN_LANES; stride <<= 1u) {
        let earlier = select(vec2<u32>(0u), scan_lanes[max(lane, stride) - stride], lane >= stride);
        workgroupBarrier();
        scan_lanes[lane] += earlier;
        workgroupBarrier();
    }
    return scan_lanes[lane] - value;
}

// The whole prefix sum by one workgroup, a stretch of rows a lane.
fn scan_all_rows(lane: u32) {
    let share = (rows() + SCAN_LANES - 1u) / SCAN_LANES;
    let first = lane * share;
    let end = min(first + share, rows());
    var own = vec2<u32>(0u);
    for (var row = first; row < end; row++) { own += row_totals(row); }
    var before = scan_of_lanes(lane, own);
    for (var row = first; row < end; row++) {
        let totals = row_totals(row);
        write_row(row, before);
        before += totals;
    }
}

// Begins the step and finds where each cell begins. One workgroup; reads `counts`, writes `cells`.
@compute @workgroup_size(SCAN_LANES)
fn scan_cells(@builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { begin_step(); }
    scan_all_rows(lane);
}

// First of three levels of the prefix sum: 256 rows a workgroup, one a lane. Reads `counts`; writes to `row_sums` what precedes
// each row in its block, and the total of the block.
@compute @workgroup_size(SCAN_LANES)
fn scan_blocks(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let block = linear_workgroup(workgroup);
    let row = block * SCAN_LANES + lane;
    var own = vec2<u32>(0u);
    if (row < rows()) { own = row_totals(row); }
    let before = scan_of_lanes(lane, own);
    if (row < rows()) { row_sums[row] = before; }
    if (lane == SCAN_LANES - 1u && block * SCAN_LANES < rows()) { row_sums[rows() + block] = before + own; }
}

// Second of three levels of the prefix sum: the totals of blocks, in one workgroup. Begins the step; updates `row_sums`.
@compute @workgroup_size(SCAN_LANES)
fn scan_tops(@builtin(local_invocation_index) lane: u32) {
    let blocks = (rows() + SCAN_LANES - 1u) / SCAN_LANES;
    let share = (blocks + SCAN_LANES - 1u) / SCAN_LANES;
    let first = lane * share;
    let end = min(first + share, blocks);
    var own = vec2<u32>(0u);
    for (var block = first; block < end; block++) { own += row_sums[rows() + block]; }
    if (lane == 0u) { begin_step(); }
    var before = scan_of_lanes(lane, own);
    for (var block = first; block < end; block++) {
        let total = row_sums[rows() + block];
        row_sums[rows() + block] = before;
        before += total;
    }
}

// Last of three levels of the prefix sum: where each cell of each row begins. One invocation a row; reads `counts` and
// `row_sums`, writes `cells`.
@compute @workgroup_size(WORKGROUP)
fn scan_rows(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let row = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (row < rows()) { write_row(row, row_sums[row] + row_sums[rows() + row / 256u]); }
}

// Slot grid/end_of_step: what the workgroups of the last kernel of a step do when they are done.
// Default: off, a kernel of its own begins the next step. The plan of particles chooses `last_workgroup` on software
// adapters whose subgroups have eight lanes.
fn end_step(lane: u32) {}
