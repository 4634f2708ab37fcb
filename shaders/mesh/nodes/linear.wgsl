// The surface under splines of order 1, written out: loops that are kept as loops cost far more.

// The surface on the nodes of a cell, [along x][along y].
fn nodes_of(column: u32, row: u32) -> Square {
    let k = vec2<u32>(node_along(column, 0u, CELLS_X), node_along(column, 1u, CELLS_X));
    let l = vec2<u32>(node_along(row, 0u, CELLS_Y), node_along(row, 1u, CELLS_Y)) * CELLS_X;
    return Square(
        surface_at(k[0] + l[0]), surface_at(k[0] + l[1]),
        surface_at(k[1] + l[0]), surface_at(k[1] + l[1]),
    );
}
