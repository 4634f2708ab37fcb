// Where each cell's particles begin in the sorted array, in rows along x that need no frames.
@group(0) @binding(3) var<storage, read_write> cells: array<u32>;

fn put_cell(index: u32, begin: u32) { cells[index] = begin; }

fn rows() -> u32 { return CELLS_Y; }
fn frame() -> u32 { return 0u; }
fn row_width() -> u32 { return CELLS_X; }
fn cell_index(row: u32, column: u32) -> u32 { return row * CELLS_X + column; }
fn row_offset_index(row: u32) -> u32 { return CELLS_X * CELLS_Y + 1u + row; }
