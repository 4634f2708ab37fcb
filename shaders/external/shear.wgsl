// Shear: periodic boundaries across an axis that move along x past each other (Lees and Edwards, doi:10.1088/0022-3719/5/15/006). The copy
// of the box above it is displaced along x by a shift that grows with time, and its particles are faster by a jump. All of it is integers.
override SHEAR_AXIS: u32;   // across which the boundaries are: 1 or 2
override SHEAR_LOW: u32;    // what the shift grows by in half a step, in 2^-64 of the box: low and high word
override SHEAR_HIGH: u32;
override SHEAR_STEP: i32;   // and in a step, in 2^-32 of the box
override SHEAR_FIRST: u32;  // the shift at the start, in 2^-32 of the box
override SHEAR_MOMENT: u32; // half steps since the step began at which a kernel sees the particles
override SHEAR_PART: u32;   // half steps in a part of a drift

// The shift some half steps after the step began, in 2^-32 of the box: the high word of a product of 64 bits, exact in every step.
fn shift_after(more: u32) -> u32 { return shift_at(sum64_add(halves_of(clock_step()), Sum64(more, 0u))); }
// The half steps before a step, and the shift after so many.
fn halves_of(step: vec2<u32>) -> Sum64 { return Sum64(step.x << 1u, (step.y << 1u) | (step.x >> 31u)); }
fn shift_at(halves: Sum64) -> u32 {
    return SHEAR_FIRST + high_of_product(halves.x, SHEAR_LOW) + halves.x * SHEAR_HIGH + halves.y * SHEAR_LOW;
}

// Slot external/shift: the shift where a kernel sees the particles. Variant kept; the plan of particles chooses it for
// kernels that visit particles one by one. Default: from the clock.
fn shift_here() -> u32 { return shift_after(SHEAR_MOMENT); }

// By how many units the momentum of a particle is larger above a boundary than below.
override SHEAR_JUMP: i32;   // of the only species
override JUMP_ENTRIES: u32; // entries before those of species in their table, in whole halves; 0 without one

fn jump_of(species: i32) -> i32 {
    if (JUMP_ENTRIES == 0u) { return SHEAR_JUMP; }
    let entry = vec4<i32>(coefficient_entry(JUMP_ENTRIES + u32(species)));
    return entry.x * 65536 + entry.y;
}

// By how many boxes the nearest copy of another particle is above it: 1, 0 or -1. Odd under exchange.
fn boxes_up(mine: Fraction, other: Fraction) -> i32 {
    let apart = bitcast<i32>(mine[SHEAR_AXIS] - other[SHEAR_AXIS]);
    let above = (apart < 0) & (mine[SHEAR_AXIS] > other[SHEAR_AXIS]);
    let below = (apart > 0) & (mine[SHEAR_AXIS] < other[SHEAR_AXIS]);
    return select(select(0, -1, below), 1, above);
}

// The momentum along x with which a particle at a place would flow, in the linear profile that rests in the middle of the box.
fn flow_at(fraction: Fraction, species: i32) -> f32 {
    let place = bitcast<i32>(fraction[SHEAR_AXIS] ^ 0x80000000u);
    return f32(jump_of(species)) * (f32(place) * 2.3283064e-10); // 2^-32
}

// A particle that drifts through boundaries.
struct ShearedFlight { place: Fraction, momentum: Steps }

// Drifts a part of a step that ends some half steps after the step began. What crosses a boundary goes on as the copy that comes in at the
// opposite one: where that is, depends on the shift at the end of the drift only.
fn drift_through(start: ShearedFlight, species: i32, end: u32) -> ShearedFlight {
    var there = start.place + unsigned(part_of_drift(momentum_word(start.momentum, species)));
    let moved = bitcast<i32>(there[SHEAR_AXIS] - start.place[SHEAR_AXIS]);
    let up = (moved >= 0) & (there[SHEAR_AXIS] < start.place[SHEAR_AXIS]);
    let down = (moved < 0) & (there[SHEAR_AXIS] > start.place[SHEAR_AXIS]);
    let crossed = select(select(0, -1, down), 1, up);
    let taken = crossed * jump_of(species);
    var momentum = start.momentum;
    momentum.x -= taken;
    there.x -= bitcast<u32>(crossed) * shift_after(end);
    note_crossing(taken);
    return ShearedFlight(there, momentum);
}

// All parts of a drift.
fn drift_through_all(start: ShearedFlight, species: i32) -> ShearedFlight {
    var flight = start;
    for (var part = 1; part <= drift_parts(); part++) { flight = drift_through(flight, species, u32(part) * SHEAR_PART); }
    return flight;
}

// Books the momentum along x that a boundary takes from a particle: low and high word, in any order.
fn note_crossing(taken: i32) {
    let value = sum64_of_i32(taken);
    // A loop, not a branch: software adapters execute both sides of a branch, atomics included, but leave a loop.
    for (var pending = taken != 0 && is_booked; pending; pending = false) {
        let before = atomicAdd(&wall_impulses[0], value.x);
        let carry = select(0u, 1u, before + value.x < before);
        atomicAdd(&wall_impulses[1], value.y + carry);
    }
}

// == external/shift/kept
// As an invocation has found it for all of its pairs.
fn shift_here() -> u32 { return shift_of_visit; }

// == space/travel/sheared
// Through boundaries that shear, which change the momentum of what crosses them: see external/shear.
fn travel(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = drift_through_all(ShearedFlight(fraction_of(position), momentum), species);
    return Travel(flight.place, flight.momentum, Steps(1));
}
fn travel_rest(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = drift_through(ShearedFlight(fraction_of(position), momentum), species, 2u * SHEAR_PART);
    return Travel(flight.place, flight.momentum, Steps(1));
}

// == space/relative_motion/sheared
// The copy of the second in the order of ids has, across a boundary that shears, a momentum of its own.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    let up = boxes_up(fraction_of(me.position), fraction_of(other.position));
    if (ONE_MASS == 1u) {
        var exact = mine - theirs;
        exact.x -= up * jump_of(species_of(me));
        return Vector(exact);
    }
    let in_order = mine_first(me, other);
    let species = vec2<i32>(species_of(me), species_of(other));
    let ordered = select(species.yx, species, in_order);
    var copy = select(mine, theirs, in_order);
    copy.x += select(-up, up, in_order) * jump_of(ordered.y);
    let difference = Vector(select(theirs, mine, in_order)) * inverse_mass_of(ordered.x)
        - Vector(copy) * inverse_mass_of(ordered.y);
    return select(-difference, difference, in_order);
}

// == pairs/apart/sheared
// The nearest copy of the other particle is one that shear displaces, and moves, across a boundary.
fn way_between(position: vec4<u32>, other: vec4<u32>) -> Steps {
    let mine = fraction_of(position);
    let theirs = fraction_of(other);
    var way = signed(mine - theirs);
    way.x -= boxes_up(mine, theirs) * bitcast<i32>(shift_here());
    return way;
}
fn copy_drift(position: vec4<u32>, other: vec4<u32>) -> Steps {
    var way = Steps(0);
    way.x = boxes_up(fraction_of(position), fraction_of(other)) * SHEAR_STEP;
    return way;
}

// == pairs/visit/sheared
// Reports need the place of the particle. Across a boundary that shears, the neighbouring cells are those of the place to which the
// shift takes it.
fn begin_visit(row: u32, me: Particle) {
    approach_faces(row);
    visited_place = fraction_of(me.position);
}
fn columns_of(me: Particle) -> vec2<u32> {
    let place = fraction_of(me.position);
    var displaced = place;
    displaced.x -= face_shift;
    return vec2<u32>(column_of(place), column_of(displaced));
}
fn column_towards(row: u32, other_row: u32, columns: vec2<u32>) -> u32 {
    return select(columns.x, columns.y, is_across(row, other_row));
}

// == pairs/hits/sheared
// As by default, but it notes where the particle is whose hits are wanted.
fn prepare_cluster_hits(row: u32, me: Particle, lane: u32, s: Stretches) {
    visited_place = fraction_of(me.position);
    hits_middle = row_middle(row);
    hits_probe = probe_of(visited_place, hits_middle);
    hits_next = candidate_of_lane(s, lane);
}

// == pairs/prefilter_source/sheared
// The prefilter reads positions, and sees the copies next to the row.
fn candidate_probe(index: u32, middle: Middle) -> Probe {
    return candidate_of(copy_at_row(fraction_of(position_at(index))), middle);
}

// == pairs/cluster_rows/sheared
// Across a boundary that shears, the stretches are displaced by the shift. That is no whole number of cells, so that they are a cell longer.
fn cluster_stretches(row: u32, lane: u32, column: u32) -> Stretches {
    approach_faces(row);
    let others = neighbour_rows() - 1u;
    let lane_row = min(lane + select(0u, 1u, lane >= others / 2u), others);
    let other_row = neighbour_row(row, lane_row);
    let lane_start = other_row * row_width();
    let own_start = row * row_width();
    // A cluster that extends round the whole box visits each cell once: the row without its frame.
    let leftmost = subgroupShuffle(column, 0u);
    let rightmost = subgroupShuffle(column, 7u);
    let whole = rightmost - leftmost + 1u + 2u * frame() > CELLS_X;
    let from_cell = select(leftmost, frame(), whole);
    let to_cell = select(rightmost + 1u + 2u * frame(), frame() + CELLS_X, whole);
    // Cells by which the stretch lies further right. The margin is wider than what columns are rounded by.
    let displaced = f32((0u - face_shift) >> 8u) * (f32(CELLS_X) / 16777216.0);
    let first = i32(floor(displaced - 0.01));
    let last = i32(floor(displaced + 0.01)) + 1;
    let across_from = u32(i32(leftmost + CELLS_X) + first) % CELLS_X;
    let across_to = across_from + rightmost - leftmost + u32(last - first) + 1u + 2u * frame();
    let whole_across = across_to > row_width() || across_to - across_from > CELLS_X;
    let is_displaced = is_across(row, other_row);
    let other_from = select(from_cell, select(across_from, frame(), whole_across), is_displaced);
    let other_to = select(to_cell, select(across_to, frame() + CELLS_X, whole_across), is_displaced);
    let begin = cell_at(lane_start + other_from);
    let length = select(0u, cell_at(lane_start + other_to) - begin, lane < others);
    let own = cell_at(own_start + from_cell);
    return stretches_of(own, cell_at(own_start + to_cell) - own, begin, length);
}

// == couplings/margin/sheared
// Copies across a boundary that shears move on without their particles. The margin holds how far they go until the
// shift reaches the next multiple of a part of it: then neighbours are listed again.
override SHEAR_MARGIN: u32; // that part, in 2^-32 of the box

fn way_from_anchor(place: Fraction, anchor: Fraction) -> Steps {
    var way = signed(place - anchor);
    way.x -= boxes_up(place, anchor) * bitcast<i32>(shift_at(halves_of(control.next)));
    return way;
}
fn is_outdated(step: vec2<u32>) -> bool {
    let halves = halves_of(step);
    let before = shift_at(sum64_add(halves, Sum64(0xfffffffeu, 0xffffffffu))); // two half steps
    return shift_at(halves) / SHEAR_MARGIN != before / SHEAR_MARGIN;
}
