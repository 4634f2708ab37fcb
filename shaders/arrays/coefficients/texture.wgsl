// The table of pairs of species, in a texture.
var coefficients: texture_storage_2d<rgba32uint, read_write>;

fn coefficient_entry(index: u32) -> vec4<f32> { return bitcast<vec4<f32>>(textureLoad(coefficients, texel(index))); }
