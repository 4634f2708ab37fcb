// Particles that have moved stay where they are, counted into their new cells, until the next step sorts them.
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> ranks: array<u32>;

fn begin_moving(cell: u32) {}
fn store_moved(cell: u32, bin: Bin, index: u32, particle: Water) {
    let moved = packed(particle);
    sorted[index].position = moved.position;
    sorted[index].velocity = moved.velocity;
    ranks[index] = atomicAdd(&counts[cell_of(particle.position)], 1u);
}
fn end_moving(cell: u32, bin: Bin) {}
