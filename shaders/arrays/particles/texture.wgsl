// The particles as they are stored, in a texture: each has a texel for its position and one for its momentum.
var particles: texture_storage_2d<rgba32uint, read_write>;

fn stored_particle(slot: u32) -> Particle {
    return Particle(stored_position(slot), bitcast<vec4<i32>>(textureLoad(particles, texel(2u * slot + 1u))));
}
fn stored_position(slot: u32) -> vec4<u32> { return textureLoad(particles, texel(2u * slot)); }
fn store_particle(slot: u32, particle: Particle) {
    store_position(slot, particle.position);
    textureStore(particles, texel(2u * slot + 1u), bitcast<vec4<u32>>(particle.momentum));
}
fn store_position(slot: u32, position: vec4<u32>) { textureStore(particles, texel(2u * slot), position); }
