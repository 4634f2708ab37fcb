// The surface under splines of order 3, written out: loops that are kept as loops cost far more.

// The surface on the nodes of a cell, [along x][along y].
fn nodes_of(column: u32, row: u32) -> Square {
    let k = vec4<u32>(node_along(column, 0u, CELLS_X), node_along(column, 1u, CELLS_X), node_along(column, 2u, CELLS_X),
        node_along(column, 3u, CELLS_X));
    let l = vec4<u32>(node_along(row, 0u, CELLS_Y), node_along(row, 1u, CELLS_Y), node_along(row, 2u, CELLS_Y),
        node_along(row, 3u, CELLS_Y)) * CELLS_X;
    return Square(
        surface_at(k[0] + l[0]), surface_at(k[0] + l[1]), surface_at(k[0] + l[2]), surface_at(k[0] + l[3]),
        surface_at(k[1] + l[0]), surface_at(k[1] + l[1]), surface_at(k[1] + l[2]), surface_at(k[1] + l[3]),
        surface_at(k[2] + l[0]), surface_at(k[2] + l[1]), surface_at(k[2] + l[2]), surface_at(k[2] + l[3]),
        surface_at(k[3] + l[0]), surface_at(k[3] + l[1]), surface_at(k[3] + l[2]), surface_at(k[3] + l[3]),
    );
}
