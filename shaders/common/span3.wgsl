// Rows around a row, further than the nearest.
fn row_at(row: u32, index: u32) -> u32 {
    let dz = index / SPAN_Y;
    let dy = index - dz * SPAN_Y;
    let z = row / CELLS_Y;
    let y = row - z * CELLS_Y;
    return ((z + dz + CELLS_Z - SPAN_Z / 2u) % CELLS_Z) * CELLS_Y + (y + dy + CELLS_Y - SPAN_Y / 2u) % CELLS_Y;
}
