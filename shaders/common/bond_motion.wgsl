// The change of a bond's length over the last drift. The last positions follow from the last drifts, which are recomputed
// to the bit.
fn last_drift(particle: Particle) -> Steps {
    return Steps(round(Vector(steps_of(particle.momentum)) * (drift_of_end(particle) / unit_lengths())));
}
fn change_of_length(me: Particle, other: Particle) -> f32 {
    let drifted = last_drift(me) - last_drift(other);
    let now = signed(fraction_of(me.position) - fraction_of(other.position));
    let after = Vector(now) * unit_lengths();
    let before = Vector(now - drifted) * unit_lengths();
    let lengths = length(after) + length(before);
    // The difference of two nearly equal lengths, without cancellation.
    let change = dot(after + before, Vector(drifted) * unit_lengths());
    return select(0.0, change / lengths, lengths > 0.0);
}
