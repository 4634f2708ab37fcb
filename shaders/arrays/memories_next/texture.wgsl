// What the bath of every listed pair remembers, for the list that is being made, in a texture.
var memories_next: texture_storage_2d<rg32uint, read_write>;

fn next_pair_memory(place: u32) -> vec2<u32> { return textureLoad(memories_next, texel(place)).xy; }
fn put_next_pair_memory(place: u32, memory: vec2<u32>) {
    textureStore(memories_next, texel(place), vec4<u32>(memory, 0u, 0u));
}
