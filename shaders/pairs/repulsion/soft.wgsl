// The soft repulsion of dissipative particle dynamics, linear in w = 1 - r/rc.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * w; }
