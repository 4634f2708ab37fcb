// The standard weight for the cutoff of each pair of species: omega = w^2 with w = 1 - r/rc, of the pair that was looked up last.
fn root_weight(w: f32) -> f32 { return own_closeness(w); }
// Zero at the cutoff of the pair and beyond.
fn coupling(w: f32) -> f32 {
    let own = own_closeness(w);
    return -0.5 * CUTOFF / pair_range.x * own * own;
}
