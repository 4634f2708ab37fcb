// The sort has collected the particles of a cell; from their number those that move are counted.
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;
fn collect(cell: u32, bin: Bin) { counts[cell] = bin.count; }
