// The rows of one of several ranks in two turns: first particles near the faces of its part, of which other ranks may have to know at
// the end of the step, then those in its inner cells, of which none has. The device visits these while the others are on their way.

override INNER_X: u32; // the first inner column
override INNER_Y: u32; // the first row of inner cells in a layer
override INNER_Z: u32; // the first layer with inner cells
override INNER_COLUMNS: u32; // inner cells in a row
override INNER_ROWS: u32; // rows of inner cells in a layer
override INNER_LAYERS: u32; // layers with inner cells
override VISITED_Y: u32; // the first row that is visited in a layer; after the last one of the layer comes its first
override VISITED_Z: u32; // the first layer that is visited; after the last one comes the first
override VISITED_ROWS: u32; // rows that are visited in a layer
override VISITED_LAYERS: u32; // layers that are visited

// The row with a number among those that are visited.
fn visited_row(number: u32) -> u32 {
    let layer = number / VISITED_ROWS;
    let y = VISITED_Y + number - layer * VISITED_ROWS;
    return (VISITED_Z + layer) % (rows() / CELLS_Y) * CELLS_Y + y % CELLS_Y;
}

// Where the inner particles of a row begin and end among the sorted ones; at the end of a row without any.
fn inner_of_row(row: u32) -> vec2<u32> {
    let z = row / CELLS_Y;
    let y = row - z * CELLS_Y;
    let inner = (y - INNER_Y < INNER_ROWS) & (z - INNER_Z < INNER_LAYERS);
    let first = cell_index(row, INNER_X);
    return select(vec2<u32>(row_end(row)), vec2<u32>(cell_at(first), cell_at(first + INNER_COLUMNS)), inner);
}

// Particles of a row that are visited: some of the sorted ones, without others between them.
struct Visited { begin: u32, end: u32, left_out: vec2<u32> }

override EDGES: u32; // 1 in the first turn, of all but the inner ones

fn visited_of_row(row: u32) -> Visited {
    if (EDGES == 1u) { return Visited(row_begin(row), row_end(row), inner_of_row(row)); }
    let inner = inner_of_row(row);
    return Visited(inner.x, inner.y, inner.yy);
}

// Visits every pair of the particles of one turn, for any subgroup size. One invocation a particle at a time; SEGMENTS workgroups share
// a row of cells. Reads and writes what visit_rows does.
@compute @workgroup_size(WORKGROUP)
fn visit_rows_of_part(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let number = group / SEGMENTS;
    if (number < VISITED_ROWS * VISITED_LAYERS) {
        let row = visited_row(number);
        let visited = visited_of_row(row);
        let skipped = visited.left_out.y - visited.left_out.x;
        let first = visited.begin + (group - number * SEGMENTS) * WORKGROUP;
        for (var place = first + lane; place < visited.end - skipped; place += WORKGROUP * SEGMENTS) {
            visit_particle_of_row(row, place + select(0u, skipped, place >= visited.left_out.x), lane);
        }
    }
    report_turns(workgroup.x >> 16u);
    pass_finish(group, lane);
}
