// Water in a bin for every cell.

// == water/storage/bins
// Every cell has a bin: a stretch for the particles that stay, and two for those that arrive, one of the step before and
// one of this step, in turn. A particle that stays in its cell stays in its bin, so that no sort is needed; but a bin holds
// only so many particles.
override ARRIVALS: u32; // of each stretch of those that arrive

struct Bin { begin: u32, stayed: u32, count: u32, turn: u32 }

fn opened_bin(cell: u32) -> Bin {
    let word = stayed[cell];
    let turn = word >> 31u;
    let low = word & 0x7fffffffu;
    // Those that did not fit were refused on arrival.
    let high = min(atomicLoad(&arrived[turn * CELLS_X * CELLS_Y + cell]), ARRIVALS);
    return Bin(cell * (CAPACITY + 2u * ARRIVALS), low, low + high, turn);
}
// Where a particle of a bin is.
fn place_in(bin: Bin, k: u32) -> u32 {
    return bin.begin + k + select(CAPACITY + bin.turn * ARRIVALS - bin.stayed, 0u, k < bin.stayed);
}

// Off: particles in bins are where they should be.
fn collect(cell: u32, bin: Bin) {}

// == water/moving/bins
// Particles that have moved stay in their bin, or go to another.
var<private> kept_in_bin: u32;

fn begin_moving(cell: u32) { kept_in_bin = 0u; }
fn store_moved(cell: u32, bin: Bin, index: u32, particle: Water) {
    let destination = cell_of(particle.position);
    let turn = 1u - bin.turn;
    var place = bin.begin + kept_in_bin;
    if (destination == cell) {
        kept_in_bin += 1u;
        failures_of_motion |= select(0u, FAILURE_FRAMES, kept_in_bin > CAPACITY);
    } else {
        let arrival = atomicAdd(&arrived[turn * CELLS_X * CELLS_Y + destination], 1u);
        if (arrival < ARRIVALS) {
            place = destination * (CAPACITY + 2u * ARRIVALS) + CAPACITY + turn * ARRIVALS + arrival;
        } else {
            failures_of_motion |= FAILURE_FRAMES;
        }
    }
    // One place in the program that stores: software adapters pay for every one.
    store_water(place, particle);
}
fn end_moving(cell: u32, bin: Bin) {
    stayed[cell] = kept_in_bin | ((1u - bin.turn) << 31u);
    atomicStore(&arrived[bin.turn * CELLS_X * CELLS_Y + cell], 0u);
}
