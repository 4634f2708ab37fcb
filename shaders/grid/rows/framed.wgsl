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

// Gives a sorted particle another momentum, and its copy in the frame of its row too.
fn keep_momentum_of_all(row: u32, index: u32, me: Particle, word: vec4<i32>) {
    keep_momentum(index, word);
    let column = column_of(fraction_of(me.position));
    if (frame() == 1u && (column == 0u || column == CELLS_X - 1u)) {
        let copies = cell_at(row * row_width() + select(0u, CELLS_X + 1u, column == 0u));
        keep_momentum(copies + index - cell_at(cell_index(row, column)), word);
    }
}
