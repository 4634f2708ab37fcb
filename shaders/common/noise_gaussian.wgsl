// Noise of a pair: a standard Gaussian number by Box and Muller's transform, the same seen from either end.
fn centred_uniform(word: u32) -> f32 { return (f32(bitcast<i32>(word) >> 8u) + 0.5) * 5.9604645e-8; } // 2^-24
// Read once an invocation: a buffer that is also written cannot be cached by the compiler.
var<private> noise_key: vec2<u32>;
fn prepare_noise() { noise_key = clock_key(); }

fn pair_noise(id: u32, other: u32) -> f32 {
    let words = pair_words(noise_key, vec2<u32>(min(id, other), max(id, other)));
    let radius = sqrt(-2.0 * log(centred_uniform(words.x) + 0.5));
    return radius * cos(6.2831853 * centred_uniform(words.y));
}
