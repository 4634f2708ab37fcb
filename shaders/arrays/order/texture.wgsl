// The order of cells, in a texture: where the particle lies that is the first in it, the second, and so on.
var order: texture_storage_2d<r32uint, read_write>;

fn in_order(number: u32) -> u32 { return textureLoad(order, texel(number)).x; }
fn set_order(number: u32, index: u32) { textureStore(order, texel(number), vec4<u32>(index)); }
