// A weight with the cutoff and the exponent of each pair of species: omega = w^(2s) with w = 1 - r/rc, of the pair that was looked
// up last.
fn root_weight(w: f32) -> f32 {
    let own = own_closeness(w);
    return select(pow(own, pair_range.y), 0.0, own <= 0.0);
}
// Zero at the cutoff of the pair and beyond.
fn coupling(w: f32) -> f32 {
    let own = own_closeness(w);
    let power = pair_range.y + 1.0;
    return -CUTOFF / (pair_range.x * power) * select(pow(own, power), 0.0, own <= 0.0);
}
