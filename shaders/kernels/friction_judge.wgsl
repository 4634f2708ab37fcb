// Adds up the sums of an iteration: whether another one is needed, and how far it goes.
override CELL_GROUPS: u32;
override TOLERANCE: f32;
override ITERATIONS: u32;
@group(0) @binding(38) var<storage, read_write> demands: array<u32>; // workgroups of an iteration, as they are and as needed

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (solver.running == 0u) { return; }
    var own = vec4<f32>(0.0);
    for (var group = lane; group < CELL_GROUPS; group += LANES) { own += solver.sums[group]; }
    let sums = sum_of_lanes(lane, own);
    if (lane == 0u) { judge(sums); }
}

fn judge(sums: vec4<f32>) {
    let first = solver.iterations == 0u;
    if (first) { solver.scale = sums.z; }
    let square = sums.x;
    let turn = select(square / solver.square, 0.0, first);
    let curvature = sums.y - select(turn * square / solver.step_length, 0.0, first);
    solver.residual = select(0.0, sqrt(square / solver.scale), square > 0.0);
    // What is not a number ends the iterations too.
    if (solver.iterations < ITERATIONS && square > TOLERANCE * TOLERANCE * solver.scale && curvature > 0.0) {
        solver.square = square;
        solver.turn = turn;
        solver.step_length = square / curvature;
        solver.iterations += 1u;
    } else {
        solver.running = 0u;
        for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = 0u; }
    }
}
