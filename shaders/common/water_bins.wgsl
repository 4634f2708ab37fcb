// Particles in bins.
@group(0) @binding(2) var<storage, read_write> bins: array<StoredWater>;

fn stored(index: u32) -> Water { return unpacked(bins[index]); }
fn store(index: u32, particle: Water) { bins[index] = packed(particle); }
