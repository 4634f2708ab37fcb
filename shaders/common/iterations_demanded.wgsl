// Iterations are kernels of their own, whose workgroups depend on whether they are needed.
@group(0) @binding(38) var<storage, read_write> demands: array<u32>; // workgroups of an iteration, as they are and as needed

fn demand_iterations() {
    for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = demands[axis]; }
}
