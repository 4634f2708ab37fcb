// All but the inner ones.
fn visited_of_row(row: u32) -> Visited { return Visited(row_begin(row), row_end(row), inner_of_row(row)); }
