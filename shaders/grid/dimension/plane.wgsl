// Two dimensions, or one: cells no narrower than the cutoff, in rows along x. An axis that is too short for three cells has one.
fn rows() -> u32 { return CELLS_Y; }
fn cell_along(fraction: u32, number: u32) -> u32 {
    return min(u32(f32(fraction >> 8u) * (f32(number) / 16777216.0)), number - 1u);
}
fn column_of(fraction: Fraction) -> u32 { return cell_along(fraction.x, CELLS_X); }
fn row_of(fraction: Fraction) -> u32 { return cell_along(fraction.y, CELLS_Y); }

// Rows that can hold neighbours of a row's particles, the row itself in the middle of the numbering.
fn neighbour_rows() -> u32 { return select(1u, 3u, CELLS_Y >= 3u); }
fn place_of_row(row: u32) -> vec2<u32> { return vec2<u32>(row, 0u); }
fn row_near(place: vec2<u32>, index: u32) -> u32 { return around(place.x + index - neighbour_rows() / 2u, CELLS_Y); }

// Rows around a row, further than the nearest.
fn row_at(row: u32, index: u32) -> u32 { return (row + index + CELLS_Y - SPAN_Y / 2u) % CELLS_Y; }
