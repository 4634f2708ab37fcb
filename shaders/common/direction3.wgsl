// A random direction in three dimensions, uniform in the cosine of its polar angle, and how a force is stored.
fn direction_of(first: u32, second: u32) -> Vector {
    let cosine = 2.0 * centred_uniform(first);
    // (1 - c)(1 + c) keeps its digits near the poles.
    let sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    // Half a turn from the centred angle, which has all its digits.
    let angle = centred_uniform(second);
    return vec3<f32>(-sine * vec2<f32>(cosine_of_turns(angle), sine_of_turns(angle)), cosine);
}
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], words[1], words[2]); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, force.y, force.z); }
