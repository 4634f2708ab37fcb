// Two independent standard Gaussian numbers of a face, the same from either cell. `part`
// tells the draws of a face from each other, and the image the faces of a pair.
var<private> noise_key: vec2<u32>;

fn face_noise(mine: u32, theirs: u32, image: u32, part: u32) -> vec2<f32> {
    let counters = vec2<u32>(min(mine, theirs) | (image << 28u), max(mine, theirs) | (part << 28u));
    return two_gaussians_of(pair_words(noise_key, counters));
}
