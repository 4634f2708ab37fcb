// How the friction of the step before was solved.
fn observe_run() {
    total_add(9u, Sum64(atomicLoad(&control.limited), atomicLoad(&control.limited_high)));
    total_add(10u, Sum64(solver.iterations, 0u));
    total_add(11u, sum64_of_f32(solver.residual * 1099511627776.0)); // 2^40
}
