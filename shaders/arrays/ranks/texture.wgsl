// Place of each particle in its cell, in a texture.
var ranks: texture_storage_2d<r32uint, read_write>;

fn rank_of(index: u32) -> u32 { return textureLoad(ranks, texel(index)).x; }
fn put_rank(index: u32, rank: u32) { textureStore(ranks, texel(index), vec4<u32>(rank)); }
