// How many particles there are in each cell.
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;
