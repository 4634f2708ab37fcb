// Waves for the next pass, in a texture.
var waves_next: texture_storage_2d<rg32uint, read_write>;

fn put_wave(index: u32, value: vec2<f32>) {
    textureStore(waves_next, texel(index), vec4<u32>(bitcast<vec2<u32>>(value), 0u, 0u));
}
