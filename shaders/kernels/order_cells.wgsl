// Brings the particles of every grid cell into the order of their numbers, so that nothing depends on the order in which they
// came, and parts those at the same place: Voronoi cells have none in common.

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    var particle = particle_at(index);
    let fraction = fraction_of(particle.position);
    let cell = cell_index(row_of(fraction), column_of(fraction));
    let begin = cell_at(cell);
    let end = cell_at(cell + 1u);
    var rank = 0u;
    var same = 0u;
    for (var other = begin; other < end; other++) {
        let place = position_at(other);
        let earlier = place.w < particle.position.w;
        rank += select(0u, 1u, earlier);
        same += select(0u, 1u, earlier && all(fraction_of(place) == fraction));
    }
    // Along a parabola, for a particle between two others on a line would have no room. Far within the margin that the
    // search for neighbours leaves to a particle for being beside its grid cell.
    let apart = Fraction(same, (same * same) & 65535u);
    particle.position = vec4<u32>(fraction + apart, particle.position.zw);
    store_particle(begin + rank, particle);
    places.elements[begin + rank] = fraction_of(particle.position);
    for (var first = index == 0u; first; first = false) { atomicStore(&places.doubtful, 0u); }
}
