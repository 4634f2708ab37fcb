// Particles in order of their cells, sorted anew every step: for any crowd.
@group(0) @binding(2) var<storage, read_write> sorted: array<StoredWater>;

struct Bin { begin: u32, count: u32 }
fn opened_bin(cell: u32) -> Bin { return Bin(cells[cell], cells[cell + 1u] - cells[cell]); }
fn place_in(bin: Bin, k: u32) -> u32 { return bin.begin + k; }
fn stored(index: u32) -> Water { return unpacked(sorted[index]); }
