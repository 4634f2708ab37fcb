// Particles in bins, in a buffer.
var<storage, read_write> bins: array<StoredWater>;

fn stored(index: u32) -> Water { return unpacked(bins[index]); }
fn store(index: u32, particle: Water) { bins[index] = packed(particle); }
