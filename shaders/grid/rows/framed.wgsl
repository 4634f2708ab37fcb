// Every row of cells is framed by copies of its last and first cell, so that the neighbourhood of any stretch of a row is
// contiguous; a row of a single cell needs no frame.
fn frame() -> u32 { return select(0u, 1u, CELLS_X >= 3u); }
fn row_width() -> u32 { return CELLS_X + 2u * frame(); }
fn cell_index(row: u32, column: u32) -> u32 { return row * row_width() + column + frame(); }
fn row_begin(row: u32) -> u32 { return cell_at(cell_index(row, 0u)); }
fn row_end(row: u32) -> u32 { return cell_at(cell_index(row, CELLS_X - 1u) + 1u); }

// The number of particles in all rows before this one: where the row begins in an array without frames.
fn row_offset_index(row: u32) -> u32 { return rows() * row_width() + 1u + row; }
fn unframed_index(row: u32, index: u32) -> u32 { return cell_at(row_offset_index(row)) + index - row_begin(row); }

// The place of the copy of a sorted particle in the frame of its row; its own place if it has none.
fn copy_in_frame(row: u32, index: u32, me: Particle) -> u32 {
    let column = column_of(fraction_of(me.position));
    if (frame() == 0u || (column != 0u && column != CELLS_X - 1u)) { return index; }
    let copies = cell_at(row * row_width() + select(0u, CELLS_X + 1u, column == 0u));
    return copies + index - cell_at(cell_index(row, column));
}
