// Visits every cell of the mesh.
@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (cell < CELLS_X * CELLS_Y) { visit_cell(cell); }
    report_turns(workgroups.x >> 16u);
}
