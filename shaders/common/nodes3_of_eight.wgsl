// The surface under the splines of order 3, for the lanes of a subgroup whose cells lie side by side: each loads one column, and
// three lanes those beside them.
fn column_of_nodes(column: u32, rows: vec4<u32>) -> vec4<f32> {
    return vec4<f32>(surface_at(column + rows[0]), surface_at(column + rows[1]), surface_at(column + rows[2]), surface_at(column + rows[3]));
}
// The surface on the nodes of a cell, [along x][along y].
fn nodes_of(column: u32, row: u32) -> Square {
    let lane = lane_of_eight;
    let rows = CELLS_X * vec4<u32>(node_along(row, 0u, CELLS_Y), node_along(row, 1u, CELLS_Y), node_along(row, 2u, CELLS_Y), node_along(row, 3u, CELLS_Y));
    let own = column_of_nodes(column, rows);
    var beside = own;
    // The column before the eight, and the two after it.
    if (lane < 3u) { beside = column_of_nodes((column - lane + select(7u + lane, CELLS_X - 1u, lane == 0u)) % CELLS_X, rows); }
    let before = select(subgroupShuffle(own, (lane + 7u) & 7u), beside, lane == 0u);
    let after = select(subgroupShuffle(own, (lane + 1u) & 7u), subgroupShuffle(beside, 1u), lane == 7u);
    let beyond = select(subgroupShuffle(own, (lane + 2u) & 7u), subgroupShuffle(beside, (lane + 3u) & 3u), lane > 5u);
    return Square(before, own, after, beyond);
}
