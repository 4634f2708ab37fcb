// Limits the push that the turn of a face causes. Between cells close to each other a small displacement turns their face
// far, and the push grows without bounds: within the time it must not turn the face over more than a part of the smaller cell.

// The part of the twist to keep: even under exchange.
fn bounded_part(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 {
    let time_and_length = STEP * facet.length;
    let swept = time_and_length * time_and_length * abs(mine.pressure - theirs.pressure) * dot(twist, twist)
        * (1.0 / mine.mass + 1.0 / theirs.mass);
    let most = EXCHANGE_LIMIT * min(mine.mass / mine.density, theirs.mass / theirs.density);
    return select(1.0, sqrt(most / swept), swept > most);
}
