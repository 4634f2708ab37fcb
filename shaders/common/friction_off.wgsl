// No friction in this scene.
fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }
