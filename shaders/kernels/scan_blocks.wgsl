// First of three levels of the prefix sum over cells: 256 rows a workgroup.
@group(0) @binding(8) var<storage, read_write> row_sums: array<vec2<u32>>; // one a row, then one a block of 256 rows

@compute @workgroup_size(SCAN_LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let block = linear_workgroup(workgroup);
    let row = block * SCAN_LANES + lane;
    var own = vec2<u32>(0u);
    if (row < rows()) { own = row_totals(row); }
    let before = scan_of_lanes(lane, own);
    if (row < rows()) { row_sums[row] = before; }
    if (lane == SCAN_LANES - 1u && block * SCAN_LANES < rows()) { row_sums[rows() + block] = before + own; }
}
