// What the bath of every listed pair remembers.
var<storage, read_write> memories: array<vec2<u32>>;

fn pair_memory(place: u32) -> vec2<u32> { return memories[place]; }
fn put_pair_memory(place: u32, memory: vec2<u32>) { memories[place] = memory; }
