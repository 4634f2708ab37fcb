// The conservative force is part of this scene.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * w; }
