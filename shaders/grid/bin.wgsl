// Counts freshly uploaded particles into cells; every later step counts as it advances.
@compute @workgroup_size(WORKGROUP)
fn bin_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let fraction = fraction_of(stored_position(index));
    put_rank(index, atomicAdd(&counts[row_of(fraction) * CELLS_X + column_of(fraction)], 1u));
}

// Puts every particle into its cell, notes what others ask for about its place, and clears the counts for the next time.
// Puts every particle into its cell, and its copy into the frame of the row, and clears the counts for the next step.
override CELLS: u32;

@compute @workgroup_size(WORKGROUP)
fn scatter_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index < CELLS) { counts[index] = 0u; }
    if (index >= PARTICLES) { return; }
    let particle = copied(index);
    let rank = rank_of(index);
    let fraction = fraction_of(copied_position(particle));
    let row = row_of(fraction);
    let column = column_of(fraction);
    let target_index = cell_at(cell_index(row, column)) + rank;
    if (target_index >= CAPACITY) {
        raise(FAILURE_FRAMES);
        return;
    }
    put_sorted(target_index, particle);
    if (frame() == 1u && (column == 0u || column == CELLS_X - 1u)) {
        let copy = cell_at(row * row_width() + select(0u, CELLS_X + 1u, column == 0u)) + rank;
        if (copy >= CAPACITY) {
            raise(FAILURE_FRAMES);
            return;
        }
        put_sorted(copy, particle);
    }
}


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
    note_anchor(slot, position);
    note_origin(slot, index);
    note_slot(position.w, slot);
}

// No neighbours are listed.
fn check_anchor(slot: u32, fraction: Fraction) {}
fn note_anchor(slot: u32, position: vec4<u32>) {}

// Nobody asks where a particle was stored before.
fn note_origin(slot: u32, before: u32) {}

// Nobody asks where a particle is stored.
fn note_slot(id: u32, slot: u32) {}
