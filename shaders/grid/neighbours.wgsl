// Rows of cells next to each other, round the box.

// A row around a row, by its number among those that can hold neighbours.
fn neighbour_row(row: u32, index: u32) -> u32 { return row_near(place_of_row(row), index); }

// A number from -1 to `count` as one of a ring.
fn around(number: u32, count: u32) -> u32 {
    let positive = min(number, number + count);
    return min(positive, positive - count);
}
