// Noise of a pair: uniform with zero mean and unit variance.

// Read once an invocation: the compiler cannot cache a buffer that is also written.
fn prepare_noise() { noise_key = clock_key(); }

// Even under exchange of the pair.
fn pair_noise(id: u32, other: u32) -> f32 {
    let word = pair_words(noise_key, vec2<u32>(min(id, other), max(id, other))).x;
    return (f32(bitcast<i32>(word) >> 8u) + 0.5) * 2.0647655e-7; // sqrt(12) / 2^24
}
