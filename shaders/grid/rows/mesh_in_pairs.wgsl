// Rows of the mesh of shallow water, whose cells are counted two at a time.

// Where each cell's particles begin.
var<storage, read_write> cells: array<Two>;
// Particles in each cell.
var<storage, read_write> counts: array<Two>;

// Particles in the row's cells, as many with its frame as without.
fn row_totals(row: u32) -> vec2<u32> {
    let first = row * (CELLS_X / 2u);
    var totals = vec2<u32>(0u);
    for (var pair = first; pair < first + CELLS_X / 2u; pair++) { totals += two_words(counts[pair]); }
    return vec2<u32>(totals.x + totals.y);
}

// Writes where each cell of the row begins, given the totals of all rows before it.
fn write_row(row: u32, before: vec2<u32>) {
    let first = row * (CELLS_X / 2u);
    var begin = before.x;
    for (var pair = first; pair < first + CELLS_X / 2u; pair++) {
        let count = two_words(counts[pair]);
        cells[pair] = stored_two(vec2<u32>(begin, begin + count.x));
        begin += count.x + count.y;
    }
}
