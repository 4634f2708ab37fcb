// Baths see velocities relative to the linear profile of a sheared box, where the particle had them: a part of the last drift ago.
override FLOW_SHARE: f32; // that part

fn flow_of_drift(me: Particle, way: Steps) -> Vector {
    let species = species_of(me);
    var flow = Vector(0.0);
    flow.x = drift_of(species) * flow_from_middle(species, from_middle(fraction_of(me.position)) - FLOW_SHARE * f32(way[SHEAR_AXIS]));
    return flow;
}
fn flow_of_particle(me: Particle) -> Vector {
    var flow = Vector(0.0);
    flow.x = flow_at(fraction_of(me.position), species_of(me));
    return flow;
}
