// The whole prefix sum over cells in one workgroup: begins the step, and is the cheapest way for up to some thousand rows.
@compute @workgroup_size(SCAN_LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    let share = (rows() + SCAN_LANES - 1u) / SCAN_LANES;
    let first = lane * share;
    let end = min(first + share, rows());
    var own = vec2<u32>(0u);
    for (var row = first; row < end; row++) { own += row_totals(row); }
    if (lane == 0u) { begin_step(); }
    var before = workgroup_scan(lane, own);
    for (var row = first; row < end; row++) {
        let totals = row_totals(row);
        write_row(row, before);
        before += totals;
    }
}
