// No conservative force in this scene.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return 0.0; }
