// Where cells begin, in a buffer.
var<storage, read_write> cells: array<u32>;

fn cell_at(index: u32) -> u32 { return cells[index]; }
fn put_cell(index: u32, begin: u32) { cells[index] = begin; }
