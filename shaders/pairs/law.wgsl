// No conservative force in this scene.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return 0.0; }

// No friction in this scene.
fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }

// No random force in this scene: zero temperature or no friction.
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }
