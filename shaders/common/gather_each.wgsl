// What each cell brings to a node.
@group(0) @binding(18) var<storage, read_write> contributions: array<i32>; // [node of the cell][cell]

fn gather_shares(column: u32, row: u32) {
    for (var l = 0u; l < WIDTH; l++) {
        let base = cell_along(row, l, CELLS_Y) * CELLS_X;
        for (var k = 0u; k < WIDTH; k++) {
            gather(contributions[(k * WIDTH + l) * (CELLS_X * CELLS_Y) + base + cell_along(column, k, CELLS_X)]);
        }
    }
}
