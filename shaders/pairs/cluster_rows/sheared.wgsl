// Across a boundary that shears, the stretches are displaced by the shift. That is no whole number of cells, so that they are a cell longer.
fn cluster_stretches(row: u32, lane: u32, column: u32) -> Stretches {
    approach_faces(row);
    let others = neighbour_rows() - 1u;
    let lane_row = min(lane + select(0u, 1u, lane >= others / 2u), others);
    let other_row = neighbour_row(row, lane_row);
    let lane_start = other_row * row_width();
    let own_start = row * row_width();
    // A cluster that extends round the whole box visits each cell once: the row without its frame.
    let leftmost = subgroupShuffle(column, 0u);
    let rightmost = subgroupShuffle(column, 7u);
    let whole = rightmost - leftmost + 1u + 2u * frame() > CELLS_X;
    let from_cell = select(leftmost, frame(), whole);
    let to_cell = select(rightmost + 1u + 2u * frame(), frame() + CELLS_X, whole);
    // Cells by which the stretch lies further right. The margin is wider than what columns are rounded by.
    let displaced = f32((0u - face_shift) >> 8u) * (f32(CELLS_X) / 16777216.0);
    let first = i32(floor(displaced - 0.01));
    let last = i32(floor(displaced + 0.01)) + 1;
    let across_from = u32(i32(leftmost + CELLS_X) + first) % CELLS_X;
    let across_to = across_from + rightmost - leftmost + u32(last - first) + 1u + 2u * frame();
    let whole_across = across_to > row_width() || across_to - across_from > CELLS_X;
    let is_displaced = is_across(row, other_row);
    let other_from = select(from_cell, select(across_from, frame(), whole_across), is_displaced);
    let other_to = select(to_cell, select(across_to, frame() + CELLS_X, whole_across), is_displaced);
    let begin = cell_at(lane_start + other_from);
    let length = select(0u, cell_at(lane_start + other_to) - begin, lane < others);
    let own = cell_at(own_start + from_cell);
    return stretches_of(own, cell_at(own_start + to_cell) - own, begin, length);
}
