// Every cell has a bin: a stretch for the particles that stay, and two for those that arrive, one of the step before and
// one of this step, in turn. What stays in its cell stays in its bin, so that no sort is needed; only a crowd in one cell
// does not fit.
override ARRIVALS: u32; // of each stretch of those that arrive
var<storage, read_write> stayed: array<u32>;          // and, in the highest bit, whose turn it is
var<storage, read_write> arrived: array<u32>; // in the first stretch, then in the second

struct Bin { begin: u32, stayed: u32, count: u32, turn: u32 }
fn opened_bin(cell: u32) -> Bin {
    let word = stayed[cell];
    let turn = word >> 31u;
    let low = word & 0x7fffffffu;
    // More than fit were refused as they arrived.
    let high = min(atomicLoad(&arrived[turn * CELLS_X * CELLS_Y + cell]), ARRIVALS);
    return Bin(cell * (CAPACITY + 2u * ARRIVALS), low, low + high, turn);
}
// Where the particles are.
fn place_in(bin: Bin, k: u32) -> u32 {
    return bin.begin + k + select(CAPACITY + bin.turn * ARRIVALS - bin.stayed, 0u, k < bin.stayed);
}

// Particles in bins are where they should be.
fn collect(cell: u32, bin: Bin) {}
