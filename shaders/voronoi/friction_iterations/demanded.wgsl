fn demand_iterations() {
    for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = demands[axis]; }
}
