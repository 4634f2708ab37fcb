// Arrays whose elements are the texels of a texture, in rows of 4096: adapters that load lane by lane assemble a vector word by
// word from a buffer, but load it whole from a texture.
const TEXELS_IN_ROW: u32 = 4096u;

fn texel(index: u32) -> vec2<u32> { return vec2<u32>(index % TEXELS_IN_ROW, index / TEXELS_IN_ROW); }
