// The surface under splines of order 3, for the cells of a strip: each lane loads one column of nodes, row after row, and
// three lanes those outside the eight.
var<private> own_nodes: vec4<f32>;    // on nodes above each other
var<private> beside_nodes: vec4<f32>; // the column before the eight, and the two after it
var<private> beside_column: u32;

fn load_row(column: u32, row: u32) {
    own_nodes = vec4<f32>(own_nodes.yzw, surface_at(CELLS_X * row + column));
    if (lane_of_eight < 3u) { beside_nodes = vec4<f32>(beside_nodes.yzw, surface_at(CELLS_X * row + beside_column)); }
}
fn begin_strip(column: u32, row: u32) {
    let lane = lane_of_eight;
    beside_column = (column - lane + select(7u + lane, CELLS_X - 1u, lane == 0u)) % CELLS_X;
    load_row(column, node_along(row, 0u, CELLS_Y));
    load_row(column, node_along(row, 1u, CELLS_Y));
    load_row(column, node_along(row, 2u, CELLS_Y));
}
// The surface on the nodes of a cell, [along x][along y], row after row of a strip.
fn nodes_of(column: u32, row: u32) -> Square {
    let lane = lane_of_eight;
    load_row(column, node_along(row, 3u, CELLS_Y));
    let before = select(subgroupShuffle(own_nodes, (lane + 7u) & 7u), beside_nodes, lane == 0u);
    let after = select(subgroupShuffle(own_nodes, (lane + 1u) & 7u), subgroupShuffle(beside_nodes, 1u), lane == 7u);
    let beyond = select(subgroupShuffle(own_nodes, (lane + 2u) & 7u), subgroupShuffle(beside_nodes, (lane + 3u) & 3u), lane > 5u);
    return Square(before, own_nodes, after, beyond);
}
