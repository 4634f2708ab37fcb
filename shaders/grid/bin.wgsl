// Sorts particles by grid cell: counts them into cells and puts each into its place, between which grid/scan finds where cells
// begin.
//
// Slots of grid, without defaults:
// - grid/dimension: rows of cells along x, and the rows around a row. Variants plane, volume; plans follow the box of the scene.
// - grid/rows: where a cell of a row is in `cells`. Variants framed (copies of the end cells at both ends of each row; pairs),
//   plain (neighbour lists and Voronoi cells), mesh and mesh_in_pairs (shallow water).
// - grid/copied: the particle as it is copied into the sorted array. Variants particles, fours; chosen by the plan of
//   particles.

override CELLS: u32;

// Slot grid/stored: which particles are stored and sorted, and which of them are reported. Default: all. The plan of
// particles chooses `of_rank` for one of several ranks, which forgets particles and gets others.
fn stored_count() -> u32 { return PARTICLES; }
fn sorted_count() -> u32 { return PARTICLES; }
fn is_own(position: vec4<u32>) -> bool { return true; }
fn forgets(index: u32) -> bool { return false; }
fn has_no_rank(rank: u32) -> bool { return false; }

// Slot grid/aside: keeps a particle as it is stored, so that it can be put into its cell in the same array. Default: off,
// particles are put into another array. The plan chooses `kept` for lists.
fn keep_aside(index: u32) {}

// Counts particles into cells that are newly uploaded, or whose neighbours are listed; where every step sorts, the one before counts as it
// advances. One invocation a stored particle; reads its position, adds to `counts`, writes `ranks`, and `sorted` if it is kept aside.
@compute @workgroup_size(WORKGROUP)
fn bin_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= stored_count() || forgets(index)) { return; }
    count_into_cell(index, fraction_of(stored_position(index)));
    keep_aside(index);
}
fn count_into_cell(slot: u32, place: Fraction) {
    put_rank(slot, atomicAdd(&counts[row_of(place) * CELLS_X + column_of(place)], 1u));
}

// Slot grid/next: what is noted of the place to which a stored particle has come. The plan chooses `cells` where
// particles are ordered by cell at every step, `anchors` where neighbours are listed.
// Default: nothing, no order is needed.
fn note_place(slot: u32, place: Fraction) {}

// Puts every particle into its cell, and a copy into the frame of the row if its cell is at an end. One invocation a stored
// particle; reads `particles`, `ranks` and `cells`, writes the sorted array, and clears `counts` for the next step.
@compute @workgroup_size(WORKGROUP)
fn scatter_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index < CELLS) { counts[index] = 0u; }
    if (index < stored_count()) { scatter_particle(index); }
}
fn scatter_particle(index: u32) {
    let rank = rank_of(index);
    if (has_no_rank(rank)) { return; }
    let particle = copied(index);
    let fraction = fraction_of(copied_position(particle));
    let row = row_of(fraction);
    let column = column_of(fraction);
    let target_index = cell_at(cell_index(row, column)) + rank;
    if (target_index >= CAPACITY) {
        raise(FAILURE_FRAMES);
        return;
    }
    put_sorted(target_index, particle);
    note_slot(copied_position(particle).w, target_index);
    if (frame() == 1u && (column == 0u || column == CELLS_X - 1u)) {
        let copy = cell_at(row * row_width() + select(0u, CELLS_X + 1u, column == 0u)) + rank;
        if (copy >= CAPACITY) {
            raise(FAILURE_FRAMES);
            return;
        }
        put_sorted(copy, particle);
    }
}

// Begins the step and sorts all particles. One workgroup, for so few that further dispatches would take longer than their turns; reads
// `particles`, `ranks` and `counts`, writes `cells` and the sorted array, and clears `counts` for the next step.
@compute @workgroup_size(SCAN_LANES)
fn sort_in_one_workgroup(@builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { begin_step(); }
    scan_all_rows(lane);
    storageBarrier();
    for (var cell = lane; cell < CELLS; cell += SCAN_LANES) { atomicStore(&counts[cell], 0u); }
    for (var index = lane; index < stored_count(); index += SCAN_LANES) { scatter_particle(index); }
}

// Puts every particle into its cell without frames, and notes what neighbour lists need to know of its place. One invocation a
// stored particle; reads `particles`, `ranks` and `cells`, writes `sorted`, and clears `counts` for the next time. For a list the plan
// exchanges the two arrays: particles come from where they were kept aside, and are stored in the new order.
@compute @workgroup_size(WORKGROUP)
fn arrange_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index < CELLS) { counts[index] = 0u; }
    if (index >= PARTICLES) { return; }
    let particle = stored_particle(index);
    let position = particle.position;
    let fraction = fraction_of(position);
    let slot = cell_at(cell_index(row_of(fraction), column_of(fraction))) + rank_of(index);
    sort_particle(slot, particle);
    note_anchor(slot, position, index);
    note_slot(position.w, slot);
}

// Slot couplings/anchors: keeps where a particle was when neighbours were listed, and where it was stored before. Default: off, no
// neighbours are listed. The plan chooses `kept` for lists.
fn note_anchor(slot: u32, position: vec4<u32>, before: u32) {}

// Slot couplings/slots: keeps where a particle is stored or sorted, by id, until it is forgotten. Default: off. Plans choose `kept` for bonds
// and angles, `of_rank` if several ranks share them.
fn note_slot(id: u32, slot: u32) {}
fn forget_slot(id: u32) {}
