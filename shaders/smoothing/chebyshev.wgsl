// Smoothing by Chebyshev's iteration. It solves (1 - Λ²∇²) x = b from x = 0, which makes x a fixed polynomial in the operator
// times b: x_{k+1} = x_{k-1} + ω_{k+1} ((b - (1 - Λ²∇²) x_k)/θ + x_k - x_{k-1}).
override NODES_X: u32;
override NODES_Y: u32;
override STIFFNESS_X: f32; // Λ²/Δx²
override STIFFNESS_Y: f32;
override INVERSE_CENTRE: f32; // 1/θ, θ the middle of the spectrum
override PARITY: u32; // of the iteration: the number that others still read must not change

const ROWS_AT_ONCE = 4u;

struct Iteration {
    done: array<u32, 2>,     // iterations finished, before one of even number and of odd
    weights: array<f32>,     // ω
}
var<storage, read_write> waves: array<f32>;
var<storage, read_write> waves_next: array<f32>;

// Slot smoothing/source: the right-hand side b on a node.
// Default: the deviation of its mass, for the first application. The plan chooses `smoothed` for the others.
fn given_depth(node: u32) -> f32 { return deviation_of_node(node); }

// First iteration, from zero: x_0 = 0, x_1 = b/θ. One invocation a node; writes `waves` and `waves_next`.
@compute @workgroup_size(WORKGROUP)
fn chebyshev_begin(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node == 0u) { iteration.done[0] = 1u; }
    if (node >= NODES_X * NODES_Y) { return; }
    waves[node] = 0.0;
    waves_next[node] = given_depth(node) * INVERSE_CENTRE;
}

// One iteration, from `waves` to `waves_next`: x_k is in `waves`, and x_{k+1} replaces x_{k-1} in `waves_next`. One invocation
// four rows of a column; reads b, `waves` and the number of iterations done.
@compute @workgroup_size(WORKGROUP)
fn chebyshev_iterate(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let done = iteration.done[PARITY];
    if (index == 0u) { iteration.done[1u - PARITY] = done + 1u; }
    let column = index % NODES_X;
    let first = index / NODES_X * ROWS_AT_ONCE;
    if (first >= NODES_Y) { return; }
    let weight = iteration.weights[done];
    let before = select(column, NODES_X, column == 0u) - 1u;
    let after = select(column + 1u, 0u, column + 1u == NODES_X);
    var below = waves[(select(first, NODES_Y, first == 0u) - 1u) * NODES_X + column];
    var here = waves[first * NODES_X + column];
    for (var row = first; row < min(first + ROWS_AT_ONCE, NODES_Y); row++) {
        let start = row * NODES_X;
        let above = waves[select(start + NODES_X, 0u, row + 1u == NODES_Y) + column];
        let smoother = here
            + STIFFNESS_X * ((here - waves[start + before]) + (here - waves[start + after]))
            + STIFFNESS_Y * ((here - below) + (here - above));
        let node = start + column;
        let previous = waves_next[node];
        let residual = given_depth(node) - smoother;
        waves_next[node] = previous + weight * (residual * INVERSE_CENTRE + (here - previous));
        below = here;
        here = above;
    }
}
