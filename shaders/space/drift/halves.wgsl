// The drift of half a step, rounded once to fractions of the box: a whole drift is exactly two of them, so that a
// report between the two changes nothing.
override HALVES: i32;
fn half_drift_steps(momentum: vec4<i32>) -> Steps {
    return Steps(round(Vector(steps_of(momentum)) * (0.5 * drift_of(species_in(momentum)) / unit_lengths())));
}
fn drift_steps(momentum: vec4<i32>) -> Steps { return HALVES * half_drift_steps(momentum); }
