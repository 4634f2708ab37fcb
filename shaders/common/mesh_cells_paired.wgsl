// Where each cell's particles begin in the sorted array, two cells of a row at a time.
@group(0) @binding(3) var<storage, read_write> cells: array<Two>;

fn rows() -> u32 { return CELLS_Y; }
