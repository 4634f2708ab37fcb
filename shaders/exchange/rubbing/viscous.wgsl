// Friction and noise at a face in a step: Flekkøy, Coveney and De Fabritiis (39), doi:10.1103/PhysRevE.62.2140.
fn rubbing(facet: Facet) -> f32 { return VISCOSITY * facet.length / facet.distance; }
// The impulse onto a cell by a difference of velocities, its own less its neighbour's.
fn drag(facet: Facet, velocity: Vector) -> Vector {
    return -rubbing(facet) * (velocity + dot(velocity, facet.direction) * facet.direction);
}
fn rubbing_impulse(facet: Facet, mine: Side, theirs: Side) -> Vector {
    let temperature = noise_temperature(mine.temperature, theirs.temperature);
    return drag(facet, mine.velocity - theirs.velocity) + random_face_impulse(facet, mine.id, theirs.id, temperature);
}
