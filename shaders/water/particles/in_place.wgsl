// Particles stay where they lie, whatever their cells, in a buffer.
var<storage, read_write> particles: array<StoredWater>;

fn load_water(index: u32) -> Water { return unpacked(particles[index]); }
fn stored_water_position(index: u32) -> vec2<u32> { return two_words(particles[index].position); }
fn store_water(index: u32, particle: Water) { particles[index] = packed(particle); }
fn store_motion(index: u32, particle: Water) {
    let moved = packed(particle);
    particles[index].position = moved.position;
    particles[index].velocity = moved.velocity;
}
