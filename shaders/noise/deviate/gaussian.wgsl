fn prepare_noise() { noise_key = clock_key(); }

fn pair_noise(id: u32, other: u32) -> f32 {
    return gaussian_of(pair_words(noise_key, vec2<u32>(min(id, other), max(id, other))));
}
