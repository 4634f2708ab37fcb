// Visits the cells of the mesh, one invocation a cell, for any subgroup size.
//
// Slots without defaults, chosen by src/families/shallow_water/plan/steps.rs:
// - mesh/pass: `visit_cell`, what is done in a cell. Variants deposit; push; push_of_eight (in strips).
// - water/storage: how the particles of a cell are found: `opened_bin`, then `place_in` for each. Variants sorted, bins.
// - water/particles: particles from and to memory. Variants in_place, bins, each in buffers or textures.
// - water/moving: where a particle goes that has moved. Variants sorted, bins.
// - water/eight: the same for eight cells side by side. Variants sorted, bins.
// - mesh/spline: order of the splines, 1 to 3, with moments and polynomials. Variants linear, quadratic, cubic.
// - mesh/nodes: the surface on the nodes under a cell's splines. mesh/spread: the masses of the nodes from those of a cell.
//   Variants by order; cubic_of_eight shares loads and stores among the cells of a strip.

// Slot water/sorted: begins a step that no sort has begun.
// Default: the step begins here. The plan chooses `by_sort` where particles are sorted.
fn begin_unsorted_step() { begin_step(); }

// Slot mesh/visited: the rows of cells that are visited.
// Default: all. The plan chooses `of_rank` for one of several ranks, which has particles in some rows.
fn first_visited_row() -> u32 { return 0u; }
fn end_of_visited_rows() -> u32 { return CELLS_Y; }

// Visits cells of the mesh row by row, for any subgroup size. One invocation a cell; the pass decides what is read and written.
@compute @workgroup_size(WORKGROUP)
fn visit_mesh_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cell = first_visited_row() * CELLS_X + linear_workgroup(workgroup) * WORKGROUP + lane;
    if (cell < end_of_visited_rows() * CELLS_X) { visit_cell(cell); }
    report_turns(workgroup.x >> 16u);
}
