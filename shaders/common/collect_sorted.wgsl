// The sort has collected the particles of a cell; those of the next step are counted from zero.
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;
fn collect(cell: u32) { counts[cell] = 0u; }
