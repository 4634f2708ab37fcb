// The random impulse of friction at a face at a temperature above zero: odd under exchange of the cells, because both
// directions are.
fn random_face_impulse(facet: Facet, mine: u32, theirs: u32, temperature: f32) -> Vector {
    let noise = face_noise(mine, theirs, facet.image, 0u);
    return sqrt(2.0 * temperature * rubbing(facet))
        * (1.4142135 * noise.x * facet.direction + noise.y * tangent(facet.direction));
}
