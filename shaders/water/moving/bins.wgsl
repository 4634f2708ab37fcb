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
