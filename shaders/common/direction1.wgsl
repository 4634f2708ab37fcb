// A random direction in one dimension, and how a force is stored.
fn direction_of(first: u32, second: u32) -> Vector { return Vector(select(-1.0, 1.0, centred_uniform(first) > 0.0), 0.0); }
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], 0.0); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, 0.0, 0.0); }
