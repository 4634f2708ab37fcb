// Visits every cell of the mesh, eight side by side in a row by the lanes of a subgroup, which may share what they load. For
// adapters whose subgroups have eight lanes and meshes whose rows are eights of cells.
var<private> lane_of_eight: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(subgroup_id) subgroup: u32, @builtin(subgroup_invocation_id) lane: u32) {
    let cell = linear_workgroup(workgroup, workgroups) * WORKGROUP + subgroup * 8u + lane;
    lane_of_eight = lane;
    if (cell < CELLS_X * CELLS_Y) { visit_cell(cell); }
}
