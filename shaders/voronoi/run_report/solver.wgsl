// How the friction of the step before was solved.
fn observe_run() {
    total_add(SUM_LIMITED_EXCHANGES, Sum64(atomicLoad(&control.limited), atomicLoad(&control.limited_high)));
    total_add(SUM_ITERATIONS, Sum64(solver.now.iterations, 0u));
    total_add(SUM_RESIDUAL, sum64_of_f32(solver.now.residual * 1099511627776.0)); // 2^40
}
