// Sizes of chains: the squared distance of the ends and the squared radius of gyration, summed for each group of chains.
override CHAINS: u32;
override CHAIN_LENGTH: f32; // squared length over its quantum

// Slot analyses/walk: the particle at a step along the bonds of a chain, and whether it was there before. The plan
// chooses `listed` for molecules. Default: consecutive numbers.
fn particle_on_walk(step: u32) -> u32 { return step; }
fn is_revisited(step: u32) -> bool { return false; }

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
    for (var step = chain.x + 1u; step < chain.x + chain.y; step++) {
        let before = stored_position(particle_on_walk(step - 1u));
        place += Vector(way_between(stored_position(particle_on_walk(step)), before)) * unit_lengths();
        sum += select(place, Vector(0.0), is_revisited(step));
        squares += select(dot(place, place), 0.0, is_revisited(step));
    }
    let beads = f32(max(chain.w, 1u));
    let gyration = squares / beads - dot(sum, sum) / (beads * beads);
    let sizes = array<Sum64, 2>(sum64_of_f32(dot(place, place) * CHAIN_LENGTH), sum64_of_f32(gyration * CHAIN_LENGTH));
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        let own = chain.z == quantity / 2u;
        reduce_quantity(group, lane, quantity, select(Sum64(0u), sizes[quantity & 1u], own));
    }
    report_turns(workgroup.x >> 16u);
}
