// Where cells begin, in a texture.
var cells: texture_storage_2d<r32uint, read_write>;

fn cell_at(index: u32) -> u32 { return textureLoad(cells, texel(index)).x; }
fn put_cell(index: u32, begin: u32) { textureStore(cells, texel(index), vec4<u32>(begin)); }
