// The list that is being made, in a texture: the number of a particle's pairs, then its pairs, one row of particles after
// the other.
var neighbours_next: texture_storage_2d<r32uint, read_write>;

fn next_neighbour_word(index: u32) -> u32 { return textureLoad(neighbours_next, texel(index)).x; }
fn put_next_neighbour_word(index: u32, word: u32) { textureStore(neighbours_next, texel(index), vec4<u32>(word)); }
