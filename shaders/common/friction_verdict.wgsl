// Whether another iteration is needed, and how far it goes.
override CELL_GROUPS: u32; // workgroups that have left sums of the right-hand side
override TOLERANCE: f32;
override ITERATIONS: u32;

fn judge(sums: vec4<f32>) {
    let first = solver.iterations == 0u;
    if (first) { solver.scale = sums.z; }
    let square = sums.x;
    let turn = select(square / solver.square, 0.0, first);
    let curvature = sums.y - select(turn * square / solver.step_length, 0.0, first);
    solver.residual = select(0.0, sqrt(square / solver.scale), square > 0.0);
    // What is not a number ends the iterations too.
    let numbers = is_number(square) && is_number(curvature);
    if (numbers && solver.iterations < ITERATIONS && square > TOLERANCE * TOLERANCE * solver.scale && curvature > 0.0) {
        solver.square = square;
        solver.turn = turn;
        solver.step_length = square / curvature;
        solver.iterations += 1u;
    } else {
        solver.running = 0u;
    }
}
