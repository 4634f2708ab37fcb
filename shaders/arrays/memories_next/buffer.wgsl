// What the bath of every listed pair remembers, for the list that is being made.
var<storage, read_write> memories_next: array<vec2<u32>>;

fn next_pair_memory(place: u32) -> vec2<u32> { return memories_next[place]; }
fn put_next_pair_memory(place: u32, memory: vec2<u32>) { memories_next[place] = memory; }
