// Puts every particle into its cell, notes what others ask for about its place, and clears the counts for the next time.
override PARTICLES: u32;
override CELLS: u32;
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
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
