// The equations of friction: what the faces of a cell add to its own. See voronoi/friction.
struct Visit {
    me: Particle,
    velocity: Vector,
    temperature: f32,
    friction: Vector, // at the velocities before it
    noise: Vector,
    block: vec3<f32>, // of the equations: xx, xy, yy
}
fn visit_face(visit: ptr<function, Visit>, face: Face) {
    let me = (*visit).me;
    let they = stored_particle(face.other);
    let facet = facet_of(face, me.position, they.position);
    let e = facet.direction;
    (*visit).friction += drag(facet, (*visit).velocity - velocity_of(they));
    (*visit).noise += random_face_impulse(facet, me.position.w, they.position.w,
        noise_temperature((*visit).temperature, temperature_of(they)));
    (*visit).block += rubbing(facet) * vec3<f32>(1.0 + e.x * e.x, e.x * e.y, 1.0 + e.y * e.y);
}
