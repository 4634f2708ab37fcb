// Particles ordered by cell, in a texture: each has a texel for its position and one for its momentum.
var sorted: texture_storage_2d<rgba32uint, read_write>;

fn position_at(index: u32) -> vec4<u32> { return textureLoad(sorted, texel(2u * index)); }
fn momentum_at(index: u32) -> vec4<i32> { return bitcast<vec4<i32>>(textureLoad(sorted, texel(2u * index + 1u))); }
fn particle_at(index: u32) -> Particle { return Particle(position_at(index), momentum_at(index)); }
fn sort_particle(index: u32, particle: Particle) {
    textureStore(sorted, texel(2u * index), particle.position);
    textureStore(sorted, texel(2u * index + 1u), bitcast<vec4<u32>>(particle.momentum));
}
