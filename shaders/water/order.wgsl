// The order of particles of shallow water by cell, and copies of them in that order. Within a cell the order is any: only sums of
// integers depend on it.

// Slot water/stored: which places in memory hold particles, and how many of these there are.
// Default: all places do, and those that are newly uploaded are not counted yet. The plan chooses `of_rank` for one of several ranks,
// which loses particles and gets others.
fn first_uncounted() -> u32 { return 0u; }
fn holds_water(index: u32) -> bool { return index < PARTICLES; }
fn ordered_count() -> u32 { return PARTICLES; }
fn note_ordered(index: u32) {}
fn note_tidied(index: u32) {}

// Counts newly stored particles in the cells of the mesh; every later step counts as it advances. One invocation a place;
// adds to `counts`.
@compute @workgroup_size(WORKGROUP)
fn bin_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = first_uncounted() + linear_workgroup(workgroup) * WORKGROUP + lane;
    if (!holds_water(index)) { return; }
    atomicAdd(&counts[cell_of(stored_water_position(index))], 1u);
    follow_arrival(index);
}

// Gives every particle its number in the order of cells. One invocation a place; adds to `cells`, after which these
// say where each cell ends, and writes `order`.
@compute @workgroup_size(WORKGROUP)
fn order_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    note_ordered(index);
    if (!holds_water(index)) { return; }
    set_order(atomicAdd(&cells[cell_of(stored_water_position(index))], 1u), index);
}

// The number of a particle, for a subgroup of eight lanes: those with the same cell, which most have, take their numbers with one
// addition, because software adapters add lane by lane.
fn taken_number(cell: u32, lane: u32) -> u32 {
    var first_lane = lane;
    var before = 0u; // lanes with the same cell
    var together = 1u;
    for (var step = 1u; step < 8u; step++) {
        let other = (lane + step) & 7u;
        let same = subgroupShuffle(cell, other) == cell;
        first_lane = min(first_lane, select(lane, other, same));
        before += select(0u, 1u, same && other < lane);
        together += select(0u, 1u, same);
    }
    var number = 0u;
    if (first_lane == lane && cell != NO_CELL) { number = atomicAdd(&cells[cell], together); }
    return subgroupShuffle(number, first_lane) + before;
}

// The same as `order_water` for adapters whose subgroups have eight lanes. One invocation a place; adds to `cells`, writes
// `order`.
@compute @workgroup_size(WORKGROUP)
fn order_water_of_eight(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32,
    @builtin(subgroup_invocation_id) lane_in_eight: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    // All lanes stay to the end, because the shuffles need their cells.
    note_ordered(index);
    let inside = holds_water(index);
    let cell = cell_of(stored_water_position(min(index, max(PARTICLES, 1u) - 1u)));
    let number = taken_number(select(NO_CELL, cell, inside), lane_in_eight);
    if (inside) { set_order(number, index); }
}

// Slot water/tidied: `copy_particle` copies a stored particle. Variants buffers, textures; the plan follows where particles are.
// No default.

// Copies the particles in the order of cells. One invocation a particle; reads `order`.
@compute @workgroup_size(WORKGROUP)
fn tidy_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (number >= ordered_count()) { return; }
    copy_particle(index_in_order(number), number);
}

// Copies ordered particles back, and makes the order that of memory. One invocation a particle; writes `order`.
@compute @workgroup_size(WORKGROUP)
fn keep_tidied_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = linear_workgroup(workgroup) * WORKGROUP + lane;
    note_tidied(number);
    if (number >= ordered_count()) { return; }
    copy_particle(number, number);
    set_order(number, number);
}
