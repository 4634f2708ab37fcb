// Words lie in memory in pairs, each loaded and stored at once: adapters that do so lane by lane pay as much for eight bytes as
// for four.
alias Two = u64;
struct Four { first: u64, second: u64 }

fn stored_two(words: vec2<u32>) -> Two { return u64(words.x) | (u64(words.y) << 32u); }
fn two_words(stored: Two) -> vec2<u32> { return vec2<u32>(u32(stored), u32(stored >> 32u)); }
fn stored_four(words: vec4<u32>) -> Four { return Four(stored_two(words.xy), stored_two(words.zw)); }
fn first_words(stored: Four) -> vec2<u32> { return two_words(stored.first); }
fn last_words(stored: Four) -> vec2<u32> { return two_words(stored.second); }
fn four_words(stored: Four) -> vec4<u32> { return vec4<u32>(two_words(stored.first), two_words(stored.second)); }
