// Last of three levels of the prefix sum over cells: where each cell of each row begins.
@group(0) @binding(8) var<storage, read_write> row_sums: array<vec2<u32>>; // one a row, then one a block of 256 rows

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let row = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (row < rows()) { write_row(row, row_sums[row] + row_sums[rows() + row / 256u]); }
}
