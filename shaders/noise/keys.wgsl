// The key of the random words that an invocation draws in this step. It is read once an invocation: the compiler cannot
// cache a buffer that is also written.
var<private> noise_key: vec2<u32>;

// Slot voronoi/noise_key: `prepare_noise` loads it for faces of Voronoi cells, chosen by the plans of that family.
// Default: off, nothing is drawn in this part of the step.
fn prepare_noise() {}

// Noise of pairs: a number of zero mean and unit variance for a pair of ids, even under exchange.
override DISTRIBUTION: u32; // 0 where pairs have no noise; 1 is uniform, 2 Gaussian

fn prepare_pair_noise() {
    if (DISTRIBUTION != 0u) { noise_key = clock_key(); }
}
fn pair_noise(id: u32, other: u32) -> f32 {
    if (DISTRIBUTION == 0u) { return 0.0; }
    let words = pair_words(noise_key, vec2<u32>(min(id, other), max(id, other)));
    if (DISTRIBUTION == 2u) { return gaussian_of(words); }
    return (f32(bitcast<i32>(words.x) >> 8u) + 0.5) * 2.0647655e-7; // sqrt(12) / 2^24
}
