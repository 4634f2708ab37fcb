// One iteration: x_k is in `waves`, and x_{k+1} takes the place of x_{k-1} in `waves_next`.
override PARITY: u32; // of the iteration, for nobody may change the number that others still read

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let done = iteration.done[PARITY];
    if (index == 0u) { iteration.done[1u - PARITY] = done + 1u; }
    let column = index % NODES_X;
    let first = index / NODES_X * STRIP;
    if (first >= NODES_Y) { return; }
    let weight = iteration.weights[done];
    let before = select(column, NODES_X, column == 0u) - 1u;
    let after = select(column + 1u, 0u, column + 1u == NODES_X);
    var below = waves[(select(first, NODES_Y, first == 0u) - 1u) * NODES_X + column];
    var here = waves[first * NODES_X + column];
    for (var row = first; row < min(first + STRIP, NODES_Y); row++) {
        let start = row * NODES_X;
        let above = waves[select(start + NODES_X, 0u, row + 1u == NODES_Y) + column];
        let smoother = here
            + STIFFNESS_X * ((here - waves[start + before]) + (here - waves[start + after]))
            + STIFFNESS_Y * ((here - below) + (here - above));
        let node = start + column;
        let previous = waves_next[node];
        let residual = given(node) - smoother;
        waves_next[node] = previous + weight * (residual * INVERSE_CENTRE + (here - previous));
        below = here;
        here = above;
    }
}
