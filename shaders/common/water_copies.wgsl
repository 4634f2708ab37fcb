// Particles that are copied as they are into the order of cells.
alias Copied = StoredWater;
@group(0) @binding(1) var<storage, read_write> particles: array<Copied>;
@group(0) @binding(2) var<storage, read_write> sorted: array<Copied>;

fn copied(index: u32) -> Copied { return particles[index]; }
fn copied_position(particle: Copied) -> vec2<u32> { return two_words(particle.position); }
fn put_copy(index: u32, particle: Copied) { sorted[index] = particle; }
