// Prediction of an exchange: all faces of a cell, and what comes in through them. See exchange/predict.
struct Visit {
    me: Particle,
    mine: Side,
    impulse: Vector,
    mass: f32,
    heat: f32,
}
fn visit_face(visit: ptr<function, Visit>, face: Face) {
    let me = (*visit).me;
    let mine = (*visit).mine;
    let they = stored_particle(face.other);
    let theirs = side_of(face.other, they);
    let facet = facet_of(face, me.position, they.position);
    let crossing = crossing_of(face, facet, mine, theirs);
    (*visit).impulse += crossing.impulse;
    (*visit).mass += crossing.mass;
    (*visit).heat += carried_energy(facet, crossing.twist, crossing.mass, mine, theirs)
        - 0.5 * dot(crossing.impulse, mine.velocity - theirs.velocity)
        + 0.5 * crossing.mass * dot(mine.velocity, mine.velocity);
}
