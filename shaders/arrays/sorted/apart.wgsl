// Particles ordered by cell, positions and momenta in a texture each; where rows have frames, with those filled in.
var sorted_positions: texture_storage_2d<rgba32uint, read_write>;
var sorted_momenta: texture_storage_2d<rgba32uint, read_write>;

fn position_at(index: u32) -> vec4<u32> { return textureLoad(sorted_positions, texel(index)); }
fn momentum_at(index: u32) -> vec4<i32> { return bitcast<vec4<i32>>(textureLoad(sorted_momenta, texel(index))); }
fn particle_at(index: u32) -> Particle { return Particle(position_at(index), momentum_at(index)); }
fn keep_momentum(index: u32, word: vec4<i32>) {
    textureStore(sorted_momenta, texel(index), bitcast<vec4<u32>>(word));
}
fn put_sorted(index: u32, particle: Copied) {
    textureStore(sorted_positions, texel(index), copied_position(particle));
    textureStore(sorted_momenta, texel(index), copied_momentum(particle));
}
