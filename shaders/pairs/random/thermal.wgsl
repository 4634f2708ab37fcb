// The random force of a pair at a temperature above zero.
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 {
    return c.noise * root * pair_noise(me.position.w, other.position.w);
}
