// What the eights of cells bring to a node: the one it lies in, and the one beside it.
@group(0) @binding(18) var<storage, read_write> contributions: array<i32>; // [cell][node], then [eight of cells][column beside it][node]

fn gather_shares(column: u32, row: u32) {
    let lane = column & 7u;
    let eights = CELLS_X / 8u;
    // Columns of the eight after this one, and of the one before.
    let beside = select((column / 8u + eights - 1u) % eights, (column / 8u + 1u) % eights, lane == 7u);
    let place = select(lane + 1u, 0u, lane == 7u);
    for (var l = 0u; l < WIDTH; l++) {
        let base = cell_along(row, l, CELLS_Y);
        gather(contributions[4u * (base * CELLS_X + column) + l]);
        if (place < 3u) {
            gather(contributions[4u * (CELLS_X * CELLS_Y + 3u * (base * eights + beside) + place) + l]);
        }
    }
}
