// Particles are copied from buffer to buffer.
var<storage, read_write> particles: array<StoredWater>;
var<storage, read_write> tidied: array<StoredWater>;

fn copy_particle(from_place: u32, to_place: u32) { tidied[to_place] = particles[from_place]; }
