// Puts every particle into its cell, and its copy into the frame of the row, and clears the counts for the next step.
override PARTICLES: u32;
override CELLS: u32;
override CAPACITY: u32; // of the sorted array, frames included
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
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
