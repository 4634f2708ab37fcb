// What a pass leaves of a particle for the next, in a texture of its own: no pass writes to a texture from which it loads.
@group(0) @binding(47) var kept_momenta: texture_storage_2d<rgba32uint, write>;

fn keep_momentum(index: u32, word: vec4<i32>) { textureStore(kept_momenta, texel(index), bitcast<vec4<u32>>(word)); }
