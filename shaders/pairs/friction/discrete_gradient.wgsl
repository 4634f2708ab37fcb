// Friction from the change of the coupling function since the last step, Cotter and Reich (18)-(21),
// doi:10.1209/epl/i2003-00621-8. Last positions follow from the last drifts, which are recomputed to the bit.
override FRICTION_PER_LENGTH: f32; // momentum units per length of drift: converts a change of phi to a momentum

fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let in_order = mine_first(me, other);
    let first = drift_steps(select(other.momentum, me.momentum, in_order));
    let second = drift_steps(select(me.momentum, other.momentum, in_order));
    let drifted = select(second - first, first - second, in_order);
    let way = drifted - copy_drift(me.position, other.position);
    let d = Vector(way_between(me.position, other.position) - way) * unit_lengths();
    let before = coupling(max(1.0 - length(d) * (1.0 / CUTOFF), 0.0));
    return -c.friction * FRICTION_PER_LENGTH * root * (coupling(contact.w) - before);
}
