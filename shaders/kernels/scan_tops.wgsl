// Second of three levels of the prefix sum over cells: the blocks, in one workgroup. Begins the step.
@group(0) @binding(8) var<storage, read_write> row_sums: array<vec2<u32>>; // one a row, then one a block of 256 rows

@compute @workgroup_size(SCAN_LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
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
