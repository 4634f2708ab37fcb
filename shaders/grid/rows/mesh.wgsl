// Rows of the mesh of shallow water, without frames.
fn frame() -> u32 { return 0u; }
fn row_width() -> u32 { return CELLS_X; }
fn cell_index(row: u32, column: u32) -> u32 { return row * CELLS_X + column; }
fn row_offset_index(row: u32) -> u32 { return CELLS_X * CELLS_Y + 1u + row; }
