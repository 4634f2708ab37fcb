// Particles that have moved are counted into their new cells, and sorted at the next step.
@group(0) @binding(1) var<storage, read_write> particles: array<StoredWater>;
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> ranks: array<u32>;

fn begin_moving(cell: u32) {}
fn store_moved(cell: u32, bin: Bin, index: u32, particle: Water) {
    particles[index] = packed(particle);
    ranks[index] = atomicAdd(&counts[cell_of(particle.position)], 1u);
}
fn end_moving(cell: u32, bin: Bin) {}
