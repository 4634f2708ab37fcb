// The kinetic energy is that of velocities relative to the linear profile of the flow; the momenta are those in the box.

fn observe_motion(species: i32, momentum: Steps, virial: Sum64) {
    reported_flow = flow_at(visited_place, species);
    var p = Vector(momentum);
    p.x -= reported_flow;
    total_add(SUM_KINETIC_ENERGY, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    total_add(SUM_VIRIAL, virial);
    total_add_momentum(momentum);
}
