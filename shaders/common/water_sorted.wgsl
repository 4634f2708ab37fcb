// Particles in order of cells.
@group(0) @binding(2) var<storage, read_write> sorted: array<StoredWater>;

fn stored(index: u32) -> Water { return unpacked(sorted[index]); }
fn store(index: u32, particle: Water) { sorted[index] = packed(particle); }
fn store_motion(index: u32, particle: Water) {
    let moved = packed(particle);
    sorted[index].position = moved.position;
    sorted[index].velocity = moved.velocity;
}
