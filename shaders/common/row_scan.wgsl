// The work of one row in the prefix sum over cells.

// Particles in the row's cells with its frame (x) and without (y).
fn row_totals(row: u32) -> vec2<u32> {
    let base = row * CELLS_X;
    var total = 0u;
    for (var column = 0u; column < CELLS_X; column++) { total += atomicLoad(&counts[base + column]); }
    let framing = select(0u, atomicLoad(&counts[base]) + atomicLoad(&counts[base + CELLS_X - 1u]), frame() == 1u);
    return vec2<u32>(total + framing, total);
}

// Writes where each cell of the row begins, given the totals of all rows before it.
fn write_row(row: u32, before: vec2<u32>) {
    let base = row * CELLS_X;
    var begin = before.x;
    if (frame() == 1u) {
        put_cell(row * row_width(), begin);
        begin += atomicLoad(&counts[base + CELLS_X - 1u]);
    }
    for (var column = 0u; column < CELLS_X; column++) {
        put_cell(cell_index(row, column), begin);
        begin += atomicLoad(&counts[base + column]);
    }
    if (frame() == 1u) {
        put_cell(cell_index(row, CELLS_X), begin);
        begin += atomicLoad(&counts[base]);
    }
    if (row == rows() - 1u) { put_cell(rows() * row_width(), begin); }
    put_cell(row_offset_index(row), before.y);
}
