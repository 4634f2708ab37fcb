// Standard Gaussian numbers from two random words, by Box and Muller's transform.
fn gaussian_of(words: vec2<u32>) -> f32 {
    return sqrt(minus_two_log(centred_uniform(words.x))) * cosine_of_turns(centred_uniform(words.y));
}
// Two that are independent of each other; the first is the one above.
fn two_gaussians_of(words: vec2<u32>) -> vec2<f32> {
    let turns = centred_uniform(words.y);
    return sqrt(minus_two_log(centred_uniform(words.x))) * vec2<f32>(cosine_of_turns(turns), sine_of_turns(turns));
}
