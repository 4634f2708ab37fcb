// Without a temperature friction has no noise.
fn random_impulse(facet: Facet, mine: u32, theirs: u32, temperature: f32) -> Vector { return Vector(0.0); }
