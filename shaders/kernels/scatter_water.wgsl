// Puts every particle into its cell of the mesh, in any order: what is made of them are sums of integers.
override PARTICLES: u32;
@group(0) @binding(3) var<storage, read_write> cells: array<atomic<u32>>; // where each cell begins, then where it ends

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let particle = copied(index);
    put_copy(atomicAdd(&cells[cell_of(copied_position(particle))], 1u), particle);
}
