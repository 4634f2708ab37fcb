// Iterations are kernels of their own, whose workgroups depend on whether they are needed.
fn demand_iterations() {
    for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = demands[axis]; }
}
