// Exchange: the faces that a cell owns, and what crosses them, in both cells. See exchange/exchange.
struct Visit {
    me: Particle,
    mine: Side,
    units: vec4<i32>, // integer units that come in: momentum, mass, energy
    fits: bool,       // whether all are within range
}
fn visit_face(visit: ptr<function, Visit>, face: Face) {
    let me = (*visit).me;
    let mine = (*visit).mine;
    let they = stored_particle(face.other);
    if (!owns_face(me.position.w, they.position.w)) { return; }
    let theirs = side_of(face.other, they);
    let facet = facet_of(face, me.position, they.position);
    let crossing = crossing_of(face, facet, mine, theirs);
    let energy = energy_through(facet, crossing.twist, crossing.impulse, crossing.mass, mine, theirs);
    let exact = vec4<f32>(crossing.impulse * IMPULSE_STEPS, crossing.mass * MASS_STEPS, energy * ENERGY_STEPS);
    let fits = all_within(exact.xy, EXCHANGED_UNITS_LIMIT) && all_within(exact.zw, EXCHANGED_UNITS_LIMIT);
    let units = vec4<i32>(round(exact));
    (*visit).fits = (*visit).fits && fits;
    (*visit).units += units;
    move_units(face.other, -units);
}
