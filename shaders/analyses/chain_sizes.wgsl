// Sizes of chains: the squared distance of the ends and the squared radius of gyration, summed for each group of chains.
override CHAINS: u32;
override CHAIN_LENGTH: f32; // squared length over its quantum

// Measures the chains of all groups. One invocation a chain; reads the particles in the order of their ids and `chain_starts`,
// writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn measure_chains(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let number = group * WORKGROUP + lane;
    var chain = vec4<u32>(0u, 0u, QUANTITIES, 0u);
    if (number < CHAINS) { chain = chain_starts[number]; }
    // From bead to bead, and so out of the box; relative to the first bead.
    var place = Vector(0.0);
    var sum = Vector(0.0);
    var squares = 0.0;
    for (var bead = 1u; bead < chain.y; bead++) {
        let before = stored_position(chain.x + bead - 1u);
        place += Vector(way_between(stored_position(chain.x + bead), before)) * unit_lengths();
        sum += place;
        squares += dot(place, place);
    }
    let beads = f32(max(chain.y, 1u));
    let gyration = squares / beads - dot(sum, sum) / (beads * beads);
    let sizes = array<Sum64, 2>(sum64_of_f32(dot(place, place) * CHAIN_LENGTH), sum64_of_f32(gyration * CHAIN_LENGTH));
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        let own = chain.z == quantity / 2u;
        reduce_quantity(group, lane, quantity, select(Sum64(0u), sizes[quantity & 1u], own));
    }
    report_turns(workgroup.x >> 16u);
}
