// Iterations are kernels of their own, which have no workgroups once they are not needed.
fn demand_iterations() {
    for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = demands[axis]; }
}
