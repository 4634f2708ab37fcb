// The random words of a pair, from Threefry2x32.
fn pair_words(key: vec2<u32>, counters: vec2<u32>) -> vec2<u32> { return threefry2x32(counters, key); }
