// Visits the cells of the mesh in strips: eight cells side by side, one a lane of a subgroup, then those in the rows above
// them. The cells of a strip may share what they load and store. For adapters whose subgroups have eight lanes and meshes of
// whole strips.
const STRIP: u32 = 4u; // rows
var<private> lane_of_eight: u32;

// What the slots mesh/nodes, mesh/spread and mesh/pass do at both ends of a strip. Defaults: off, cells of a strip share nothing.
fn begin_strip(column: u32, row: u32) {}
fn end_strip(column: u32, row: u32) {}

// Visits the cells of the mesh in strips, for subgroups of eight lanes. One lane a column of a strip, of four cells; the pass
// decides what is read and written: slot mesh/pass, see mesh/cells.
@compute @workgroup_size(WORKGROUP)
fn visit_mesh_strips(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(subgroup_id) subgroup: u32,
    @builtin(subgroup_invocation_id) lane: u32) {
    let strip = linear_workgroup(workgroup) * (WORKGROUP / 8u) + subgroup;
    let row = (first_visited_row() / STRIP + strip / (CELLS_X / 8u)) * STRIP;
    if (row >= end_of_visited_rows()) { return; }
    lane_of_eight = lane;
    let column = strip % (CELLS_X / 8u) * 8u + lane;
    begin_strip(column, row);
    // Written out: what is kept from row to row costs more in a loop.
    visit_cell((row + 0u) * CELLS_X + column);
    visit_cell((row + 1u) * CELLS_X + column);
    visit_cell((row + 2u) * CELLS_X + column);
    visit_cell((row + 3u) * CELLS_X + column);
    end_strip(column, row);
    report_turns(workgroup.x >> 16u);
}
