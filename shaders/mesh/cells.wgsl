// Visits every cell of the mesh.
@compute @workgroup_size(WORKGROUP)
fn visit_mesh_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (cell < CELLS_X * CELLS_Y) { visit_cell(cell); }
    report_turns(workgroup.x >> 16u);
}

// Without a sort, the step begins here.
fn begin_unsorted_step() { begin_step(); }
