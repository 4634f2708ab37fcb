// Reported particles are kept for the rest of the step, and where the host looks for them.
@group(0) @binding(1) var<storage, read_write> particles: array<StoredWater>;
fn store_reported(index: u32, particle: Water) {
    store(index, particle);
    particles[index] = packed(particle);
}
