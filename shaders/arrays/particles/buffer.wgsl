// The particles as they are stored, in a buffer.
var<storage, read_write> particles: array<Particle>;

fn stored_particle(slot: u32) -> Particle { return particles[slot]; }
fn stored_position(slot: u32) -> vec4<u32> { return particles[slot].position; }
fn store_particle(slot: u32, particle: Particle) { particles[slot] = particle; }
fn store_position(slot: u32, position: vec4<u32>) { particles[slot].position = position; }
