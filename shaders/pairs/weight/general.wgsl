// A general weight: omega = w^(2s) with w = 1 - r/rc.
override WEIGHT_ROOT_EXPONENT: f32; // s

fn root_weight(w: f32) -> f32 { return select(pow(w, WEIGHT_ROOT_EXPONENT), 0.0, w <= 0.0); }
// Zero at the cutoff and beyond.
fn coupling(w: f32) -> f32 {
    return -CUTOFF / (WEIGHT_ROOT_EXPONENT + 1.0) * select(pow(w, WEIGHT_ROOT_EXPONENT + 1.0), 0.0, w <= 0.0);
}
