// The weight of friction and noise: omega = w^(2s) with w = 1 - r/rc of the friction of a pair, its root, and the
// coupling function phi with phi' = root of omega, zero at the cutoff and beyond. `w` is that of the largest cutoff.
override WEIGHT_ROOT_EXPONENT: f32; // s of all pairs: that of the standard weight is 1; 0 where pairs differ

fn root_weight(w: f32) -> f32 {
    let own = friction_closeness(w);
    if (WEIGHT_ROOT_EXPONENT == 1.0) { return own; }
    return select(pow(own, root_exponent()), 0.0, own <= 0.0);
}
fn coupling(w: f32) -> f32 {
    let own = friction_closeness(w);
    if (WEIGHT_ROOT_EXPONENT == 1.0) { return -0.5 * friction_cutoff() * own * own; }
    let power = root_exponent() + 1.0;
    return -friction_cutoff() / power * select(pow(own, power), 0.0, own <= 0.0);
}

// Pairs of species may have ranges of their own: cutoffs or exponents that differ, or several repulsions.
override RANGED: u32; // 1 where they have

// Those of the pair whose coefficients were looked up last, which callers do first: the largest cutoff over that of its
// friction, half the exponent of its weight, and the largest cutoff over that of its repulsion. Symmetric, so that both
// ends of a pair have the same.
var<private> pair_range: vec4<f32>;

fn friction_closeness(w: f32) -> f32 {
    if (RANGED == 0u) { return w; }
    return closeness_within(w, pair_range.x);
}
fn friction_cutoff() -> f32 {
    if (RANGED == 0u) { return CUTOFF; }
    return CUTOFF / pair_range.x;
}
fn root_exponent() -> f32 {
    if (RANGED == 0u) { return WEIGHT_ROOT_EXPONENT; }
    return pair_range.y;
}
// 1 - r/rc for a cutoff, from that for the largest cutoff, which is `stretch` times as long; zero beyond.
fn closeness_within(w: f32, stretch: f32) -> f32 {
    let own = 1.0 - (1.0 - w) * stretch;
    return select(own, 0.0, own <= 0.0);
}
