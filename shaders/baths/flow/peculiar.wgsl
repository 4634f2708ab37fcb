// Baths see velocities relative to the linear profile of a sheared box where the particle is. For the drift of the last
// step that is exact in the stress of a report; the flow of a part s of the drift before would make it 1 + s gamma dt /
// m times as large.
fn flow_of_drift(me: Particle) -> Vector { return drift_of(species_of(me)) * flow_of_particle(me); }
fn flow_of_particle(me: Particle) -> Vector {
    var flow = Vector(0.0);
    flow.x = flow_at(fraction_of(me.position), species_of(me));
    return flow;
}
