// What the bath of every listed pair remembers, in a texture.
var memories: texture_storage_2d<rg32uint, read_write>;

fn pair_memory(place: u32) -> vec2<u32> { return textureLoad(memories, texel(place)).xy; }
fn put_pair_memory(place: u32, memory: vec2<u32>) {
    textureStore(memories, texel(place), vec4<u32>(memory, 0u, 0u));
}
