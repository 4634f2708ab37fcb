// Waves as the pass before has left them, in a texture.
var waves: texture_storage_2d<rg32uint, read_write>;

fn wave(index: u32) -> vec2<f32> { return bitcast<vec2<f32>>(textureLoad(waves, texel(index)).xy); }
