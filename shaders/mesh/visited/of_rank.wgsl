// Of several ranks: the rows of its part. A part of no width is all of the box.
fn first_visited_row() -> u32 { return place_along(domains[OWN].low.y, CELLS_Y).cell; }
fn end_of_visited_rows() -> u32 {
    let width = domains[OWN].width.y;
    let last = place_along(domains[OWN].low.y + width - 1u, CELLS_Y).cell;
    return select(last + 1u, CELLS_Y, width == 0u);
}
