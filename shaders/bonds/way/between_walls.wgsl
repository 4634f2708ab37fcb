// Between walls a bath with memory sees the way that an end has taken; one without sees its velocity, as friction does.
fn way_of_end(kind: BondKind, particle: Particle) -> Steps {
    return select(last_drift(particle), last_way(particle.position, particle.momentum), kind.remembers);
}
