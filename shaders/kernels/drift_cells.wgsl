// Half a drift of every cell, which is then counted into the grid: A in a split step is one half before its exchanges and
// one after them.
override PARTICLES: u32;
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>; // particles in each grid cell

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = stored_particle(slot);
    let position = drifted(me, velocity_of(me));
    store_position(slot, position);
    let fraction = fraction_of(position);
    put_rank(slot, atomicAdd(&counts[row_of(fraction) * CELLS_X + column_of(fraction)], 1u));
}
