// Rows of cells without frames, of a sorted array that holds every particle once.
fn frame() -> u32 { return 0u; }
fn row_width() -> u32 { return CELLS_X; }
fn cell_index(row: u32, column: u32) -> u32 { return row * CELLS_X + column; }
fn copy_in_frame(row: u32, index: u32, me: Particle) -> u32 { return index; }
fn unframed_index(row: u32, index: u32) -> u32 { return index; }
fn row_offset_index(row: u32) -> u32 { return rows() * CELLS_X + 1u + row; }
fn row_begin(row: u32) -> u32 { return cell_at(cell_index(row, 0u)); }
fn row_end(row: u32) -> u32 { return cell_at(cell_index(row, CELLS_X - 1u) + 1u); }
