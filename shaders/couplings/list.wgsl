// The list of neighbours within the cutoff and a margin, for steps that visit only listed pairs.
//
// A list is made in arrays of its own and then copied, so that the old one is there while memories are carried over.
override LIST_CAPACITY: u32;  // pairs that a particle may own
override SQUARED_RANGE: f32;  // of cutoff and margin

// A listed neighbour: where it is stored; the highest bit marks an excluded pair.
const NEIGHBOUR_MASK: u32 = 0x7fffffffu;

// Whether the first of two particles owns their pair. Every pair has one owner: the smaller id if the sum of the ids is odd, the
// larger if it is even, so that all own about as many.
fn owns(id: u32, other: u32) -> bool { return (id < other) == (((id + other) & 1u) == 1u) && id != other; }

override EXCLUSIONS: u32 = 0u; // partners in a row of those from whose repulsion a particle is excluded

// Slot couplings/exclusions: `excluded` gives the bit that marks a pair without repulsion; `unless_excluded`
// (couplings/pairs) reads it. Default: off. The plan chooses `listed` if bonds exclude pairs.
fn excluded(id: u32, other: u32) -> u32 { return 0u; }

// Slot couplings/margin: how far a particle is from where it was when neighbours were listed, and whether a list is
// outdated when a step begins, however little particles have moved. The plan chooses `sheared` if the scene has shear.
// Default: only particles move.
fn way_from_anchor(place: Fraction, anchor: Fraction) -> Steps { return signed(place - anchor); }
fn is_outdated(step: vec2<u32>) -> bool { return false; }

// After an upload: where the particles are stored, and whether their neighbours have to be listed. One invocation a stored
// particle.
@compute @workgroup_size(WORKGROUP)
fn take_stock(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let position = stored_position(slot);
    note_slot(position.w, slot);
    note_place(slot, fraction_of(position));
}

// Lists the pairs that a particle owns. One invocation a sorted particle; reads the sorted particles and `cells`, writes
// `neighbours_next`.
@compute @workgroup_size(WORKGROUP)
fn list_neighbours(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = particle_at(slot);
    let position = me.position;
    let row = row_of(fraction_of(position));
    begin_visit(row, me);
    let columns = columns_of(me);
    var count = 0u;
    for (var across = 0u; across < SPAN_Y * SPAN_Z; across++) {
        let other_row = row_at(row, across);
        let column = column_towards(row, other_row, columns);
        for (var along = 0u; along < SPAN_X; along++) {
            let cell = cell_index(other_row, (column + along + CELLS_X - SPAN_X / 2u) % CELLS_X);
            let end = cell_at(cell + 1u);
            for (var other = cell_at(cell); other < end; other++) {
                let there = position_at(other);
                let d = Vector(way_between(position, there)) * unit_lengths();
                if (dot(d, d) < SQUARED_RANGE && owns(position.w, there.w)) {
                    count += 1u;
                    if (count <= LIST_CAPACITY) {
                        put_next_neighbour_word(count * PARTICLES + slot, other | excluded(position.w, there.w));
                    }
                }
            }
        }
    }
    put_next_neighbour_word(slot, min(count, LIST_CAPACITY));
    raise(select(0u, FAILURE_FRAMES, count > LIST_CAPACITY));
    report_turns(workgroup.x >> 16u);
}

override START_STREAM_X: u32; // key of the random words of new pairs, over all steps
override START_STREAM_Y: u32;

// Carries what the baths of listed pairs remember from one list to the next; a pair that meets for the first time draws its
// memory from equilibrium. One invocation a sorted particle; reads both lists, `came_from` and `memories`, writes
// `memories_next`.
@compute @workgroup_size(WORKGROUP)
fn carry_memories(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let key = threefry2x32(clock_step(), vec2<u32>(START_STREAM_X, START_STREAM_Y));
    let me = particle_at(slot);
    let before = came_from[slot];
    let known = neighbour_word(before);
    let count = next_neighbour_word(slot);
    for (var entry = 0u; entry < count; entry++) {
        let other_slot = next_neighbour_word((entry + 1u) * PARTICLES + slot) & NEIGHBOUR_MASK;
        let other_before = came_from[other_slot];
        var found = known;
        for (var old = 0u; old < known && found == known; old++) {
            if ((neighbour_word((old + 1u) * PARTICLES + before) & NEIGHBOUR_MASK) == other_before) { found = old; }
        }
        var memory: vec2<u32>;
        if (found < known) {
            memory = pair_memory(found * PARTICLES + before);
        } else {
            let other = particle_at(other_slot);
            let ids = vec2<u32>(min(me.position.w, other.position.w), max(me.position.w, other.position.w));
            let c = coefficients_of(species_of(me), species_of(other));
            let start = PERSISTENCE * c.noise * gaussian_of(pair_words(key, ids));
            memory = vec2<u32>(bitcast<u32>(start), clock_step().x - 1u);
        }
        put_next_pair_memory(entry * PARTICLES + slot, memory);
    }
}

// Stores the particles in the new order. One invocation a sorted particle.
@compute @workgroup_size(WORKGROUP)
fn settle_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    store_particle(slot, particle_at(slot));
}

// Replaces the old list and its memories by the new ones. One invocation a particle, for the pairs that it owns.
@compute @workgroup_size(WORKGROUP)
fn settle_list(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let count = next_neighbour_word(slot);
    put_neighbour_word(slot, count);
    for (var entry = 0u; entry < count; entry++) {
        let place = entry * PARTICLES + slot;
        put_neighbour_word(place + PARTICLES, next_neighbour_word(place + PARTICLES));
        put_pair_memory(place, next_pair_memory(place));
    }
}
