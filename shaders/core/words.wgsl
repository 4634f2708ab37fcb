// How words lie in memory: in vectors of two and four.
//
// Slot core/words: types `Two` and `Four`, and functions to pack two or four words and to unpack them. The words are the same.
// Default: vectors. The plan chooses `pairs` for kernels that mostly move words on software adapters (src/plan/serial_memory.rs).
alias Two = vec2<u32>;
alias Four = vec4<u32>;

fn stored_two(words: vec2<u32>) -> Two { return words; }
fn two_words(stored: Two) -> vec2<u32> { return stored; }
fn stored_four(words: vec4<u32>) -> Four { return words; }
fn first_words(stored: Four) -> vec2<u32> { return stored.xy; }
fn last_words(stored: Four) -> vec2<u32> { return stored.zw; }
fn four_words(stored: Four) -> vec4<u32> { return stored; }
