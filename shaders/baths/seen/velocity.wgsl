// Friction sees velocities, predicted ones where the integrator predicts them: their drift in a step.
fn drift_seen(me: Particle) -> Vector { return Vector(friction_momentum(me)) * drift_of(species_of(me)); }
fn change_seen(kind: BondKind, me: Particle, other: Particle) -> f32 {
    let mine = Vector(friction_momentum(me)) * drift_of_end(me);
    let theirs = Vector(friction_momentum(other)) * drift_of_end(other);
    let relative = mine - theirs - Vector(copy_drift(me.position, other.position)) * unit_lengths();
    return dot(contact_of(separation(me.position, other.position)).direction, relative);
}
