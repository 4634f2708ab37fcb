// The whole prefix sum over cells by one workgroup: the cheapest way for up to some thousand rows.
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
