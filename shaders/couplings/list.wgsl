// The list of neighbours within the cutoff and a margin, for steps that visit only listed pairs.
override LIST_CAPACITY: u32;  // pairs that a particle may own
override SQUARED_RANGE: f32;  // of cutoff and margin

// A listed neighbour: where it is stored; the highest bit marks an excluded pair.
const NEIGHBOUR_MASK: u32 = 0x7fffffffu;

// Whether the first of two particles owns their pair. Every pair has one owner: the smaller id if the sum of the ids is odd, the
// larger if it is even, so that all own about as many.
fn owns(id: u32, other: u32) -> bool { return (id < other) == (((id + other) & 1u) == 1u) && id != other; }

// Where an entry of a particle's pairs is in `neighbours`, behind their number as entry 0; and what the pair remembers in `memories`. A list is
// a row of particles for every entry, and a second list follows the first.
fn place_in_list(list: u32, entry: u32, slot: u32) -> u32 {
    return (list * (LIST_CAPACITY + 1u) + entry) * PARTICLES + slot;
}
fn place_of_memory(list: u32, entry: u32, slot: u32) -> u32 {
    return (list * LIST_CAPACITY + entry - 1u) * PARTICLES + slot;
}

// Slot couplings/lists: `current_list` is the number of the list that holds, `carry_memories` gives the pairs in a new one what they
// remember. Default: one list, made again in its place, whose pairs remember nothing. The plan chooses `by_turns` for pairs with memory.
fn current_list() -> u32 { return 0u; }
fn carry_memories(slot: u32, count: u32) {}

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

// Lists the pairs that a particle owns. One invocation a stored particle; reads particles in order of cells and `cells`, writes
// `neighbours`, and `memories` if pairs remember.
@compute @workgroup_size(WORKGROUP)
fn list_neighbours(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let list = current_list();
    let me = stored_particle(slot);
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
                let there = stored_position(other);
                let d = Vector(way_between(position, there)) * unit_lengths();
                if (dot(d, d) < SQUARED_RANGE && owns(position.w, there.w)) {
                    count += 1u;
                    if (count <= LIST_CAPACITY) {
                        put_neighbour_word(place_in_list(list, count, slot), other | excluded(position.w, there.w));
                    }
                }
            }
        }
    }
    let listed = min(count, LIST_CAPACITY);
    put_neighbour_word(place_in_list(list, 0u, slot), listed);
    carry_memories(slot, listed);
    raise(select(0u, FAILURE_FRAMES, count > LIST_CAPACITY));
    report_turns(workgroup.x >> 16u);
}
