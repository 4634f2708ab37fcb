// Lists the neighbours of every particle within the cutoff and a margin. Every pair is listed once, by its owner, which
// its numbers tell: the smaller of an odd sum, the larger of an even one, so that all own about as many.
override PARTICLES: u32;
override LIST_CAPACITY: u32;  // pairs that a particle may own
override SQUARED_RANGE: f32;  // of cutoff and margin
override SPAN_X: u32; // cells to visit on each axis, centred on the particle's
override SPAN_Y: u32;
override SPAN_Z: u32;

fn owns(id: u32, other: u32) -> bool { return (id < other) == (((id + other) & 1u) == 1u) && id != other; }

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let position = position_at(slot);
    let fraction = fraction_of(position);
    let row = row_of(fraction);
    let column = column_of(fraction);
    var count = 0u;
    for (var across = 0u; across < SPAN_Y * SPAN_Z; across++) {
        let other_row = row_at(row, across);
        for (var along = 0u; along < SPAN_X; along++) {
            let cell = cell_index(other_row, (column + along + CELLS_X - SPAN_X / 2u) % CELLS_X);
            let end = cell_at(cell + 1u);
            for (var other = cell_at(cell); other < end; other++) {
                let there = position_at(other);
                let d = Vector(signed(fraction - fraction_of(there))) * unit_lengths();
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
