// Noise of a pair: a standard Gaussian number, the same seen from either end.
// Read once an invocation: a buffer that is also written cannot be cached by the compiler.
fn prepare_noise() { noise_key = clock_key(); }

fn pair_noise(id: u32, other: u32) -> f32 {
    return gaussian_of(pair_words(noise_key, vec2<u32>(min(id, other), max(id, other))));
}
