// Particles that have moved stay where they lie; those that go to another cell are counted there.
fn begin_moving(cell: u32) {}
fn store_moved(cell: u32, bin: Bin, index: u32, particle: Water) {
    store_motion(index, particle);
    let destination = cell_of(particle.position);
    if (destination != cell) {
        atomicAdd(&counts[destination], 1u);
        atomicSub(&counts[cell], 1u);
    }
}
fn end_moving(cell: u32, bin: Bin) {}
