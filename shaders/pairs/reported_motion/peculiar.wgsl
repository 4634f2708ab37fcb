// The kinetic energy is that of velocities relative to the linear profile of the flow; the momenta are those in the box.
var<private> reported_flow: f32; // along x, where the particle is

fn observe_motion(species: i32, momentum: Steps, virial: Sum64) {
    reported_flow = flow_at(visited_place, species);
    var p = Vector(momentum);
    p.x -= reported_flow;
    pair_total_add(0u, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    pair_total_add(1u, virial);
    let word = momentum_word(momentum, species);
    pair_total_add(2u, sum64_of_i32(word.x));
    pair_total_add(3u, sum64_of_i32(word.y));
    if (DIMENSION == 3u) { pair_total_add(4u, sum64_of_i32(word.z)); }
}
