// No random force in this scene: zero temperature or no friction.
fn prepare_noise() {}
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }
