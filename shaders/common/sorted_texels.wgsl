// Particles ordered by cell, in textures; where rows have frames, with those filled in.
@group(0) @binding(2) var sorted_positions: texture_2d<u32>;
@group(0) @binding(46) var sorted_momenta: texture_2d<u32>;

fn position_at(index: u32) -> vec4<u32> { return textureLoad(sorted_positions, texel(index), 0); }
fn momentum_at(index: u32) -> vec4<i32> { return bitcast<vec4<i32>>(textureLoad(sorted_momenta, texel(index), 0)); }
fn particle_at(index: u32) -> Particle { return Particle(position_at(index), momentum_at(index)); }
