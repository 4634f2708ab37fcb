// The number of a particle's pairs, then its pairs: one row of particles after the other, in a texture.
var neighbours: texture_storage_2d<r32uint, read_write>;

fn neighbour_word(index: u32) -> u32 { return textureLoad(neighbours, texel(index)).x; }
fn put_neighbour_word(index: u32, word: u32) { textureStore(neighbours, texel(index), vec4<u32>(word)); }
