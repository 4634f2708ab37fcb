// Noise of a pair: a standard Gaussian number.

// Read once an invocation: the compiler cannot cache a buffer that is also written.
fn prepare_noise() { noise_key = clock_key(); }

// Even under exchange of the pair.
fn pair_noise(id: u32, other: u32) -> f32 {
    return gaussian_of(pair_words(noise_key, vec2<u32>(min(id, other), max(id, other))));
}
