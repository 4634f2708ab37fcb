// Three dimensions: cells no narrower than the cutoff, in rows along x, rows of a layer one after the other. An axis that is
// too short for three cells has one.
override CELLS_Z: u32;

fn rows() -> u32 { return CELLS_Y * CELLS_Z; }
fn cell_along(fraction: u32, number: u32) -> u32 {
    return min(u32(f32(fraction >> 8u) * (f32(number) / 16777216.0)), number - 1u);
}
fn column_of(fraction: Fraction) -> u32 { return cell_along(fraction.x, CELLS_X); }
fn row_of(fraction: Fraction) -> u32 {
    return cell_along(fraction.z, CELLS_Z) * CELLS_Y + cell_along(fraction.y, CELLS_Y);
}

// Rows that can hold neighbours of a row's particles, the row itself in the middle of the numbering.
fn reach_y() -> u32 { return select(1u, 3u, CELLS_Y >= 3u); }
fn reach_z() -> u32 { return select(1u, 3u, CELLS_Z >= 3u); }
fn neighbour_rows() -> u32 { return reach_y() * reach_z(); }
// Layer and row in the layer, to be found once for all neighbours of a row.
fn place_of_row(row: u32) -> vec2<u32> {
    let z = row / CELLS_Y;
    return vec2<u32>(row - z * CELLS_Y, z);
}
fn row_near(place: vec2<u32>, index: u32) -> u32 {
    let dz = index / reach_y();
    let dy = index - dz * reach_y();
    return around(place.y + dz - reach_z() / 2u, CELLS_Z) * CELLS_Y + around(place.x + dy - reach_y() / 2u, CELLS_Y);
}

// Rows around a row, further than the nearest.
fn row_at(row: u32, index: u32) -> u32 {
    let dz = index / SPAN_Y;
    let dy = index - dz * SPAN_Y;
    let place = place_of_row(row);
    return ((place.y + dz + CELLS_Z - SPAN_Z / 2u) % CELLS_Z) * CELLS_Y + (place.x + dy + CELLS_Y - SPAN_Y / 2u) % CELLS_Y;
}
