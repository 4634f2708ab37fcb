// The standard weight: omega = w^2 with w = 1 - r/rc, so its root is w itself.
fn root_weight(w: f32) -> f32 { return w; }
// Zero at the cutoff and beyond.
fn coupling(w: f32) -> f32 { return -0.5 * CUTOFF * w * w; }
