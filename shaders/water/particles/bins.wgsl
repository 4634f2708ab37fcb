// Particles in bins, in a buffer.
var<storage, read_write> bins: array<StoredWater>;

fn load_water(index: u32) -> Water { return unpacked(bins[index]); }
fn store_water(index: u32, particle: Water) { bins[index] = packed(particle); }
