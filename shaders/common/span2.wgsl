// Rows around a row, further than the nearest.
fn row_at(row: u32, index: u32) -> u32 { return (row + index + CELLS_Y - SPAN_Y / 2u) % CELLS_Y; }
