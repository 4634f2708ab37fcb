// Particles that have moved stay in their bin, at the bottom, or go to the top of another.
@group(0) @binding(3) var<storage, read_write> stayed: array<u32>;
@group(0) @binding(5) var<storage, read_write> arrived: array<atomic<u32>>;
var<private> kept: u32;

fn begin_moving(cell: u32) { kept = cell * CAPACITY; }
fn store_moved(cell: u32, index: u32, particle: Water) {
    let destination = cell_of(particle.position);
    var place = kept;
    if (destination == cell) {
        kept += 1u;
    } else {
        let arrival = atomicAdd(&arrived[destination], 1u);
        // Not among those that the other cell has yet to move.
        if (residents[destination] + arrival < CAPACITY) {
            place = (destination + 1u) * CAPACITY - 1u - arrival;
        } else {
            failures_of_motion |= FAILURE_FRAMES;
        }
    }
    // One place in the program that stores: software adapters pay for every one.
    bins[place] = particle;
}
fn end_moving(cell: u32) { stayed[cell] = kept - cell * CAPACITY; }
