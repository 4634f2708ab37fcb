// Counts freshly uploaded particles into cells; every later step counts as it advances.
override PARTICLES: u32;
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let fraction = fraction_of(stored_position(index));
    put_rank(index, atomicAdd(&counts[row_of(fraction) * CELLS_X + column_of(fraction)], 1u));
}
