// A random direction in two dimensions, and how a force is stored.
fn direction_at(turns: f32) -> Vector {
    let angle = turns - round(turns);
    return Vector(cosine_of_turns(angle), sine_of_turns(angle));
}
// Half a turn from the centred angle, which has all its digits.
fn direction_of(first: u32, second: u32) -> Vector { return -direction_at(centred_uniform(first)); }
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], words[1]); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, force.y, 0.0); }
