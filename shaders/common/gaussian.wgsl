// A standard Gaussian number from two random words, by Box and Muller's transform.
fn uniform_of(word: u32) -> f32 { return (f32(bitcast<i32>(word) >> 8u) + 0.5) * 5.9604645e-8; } // 2^-24, centred
fn gaussian_of(words: vec2<u32>) -> f32 {
    return sqrt(-2.0 * log(uniform_of(words.x) + 0.5)) * cos(6.2831853 * uniform_of(words.y));
}
