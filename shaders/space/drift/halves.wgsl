// The drift of a whole step is exactly two halves, each rounded once: a report between the two changes nothing.
override HALVES: i32;

fn half_drift_steps(momentum: vec4<i32>) -> Steps {
    return Steps(round(Vector(steps_of(momentum)) * (0.5 * drift_of(species_in(momentum)) / unit_lengths())));
}
fn drift_steps(momentum: vec4<i32>) -> Steps { return HALVES * half_drift_steps(momentum); }
fn drift_parts() -> i32 { return HALVES; }
fn part_of_drift(momentum: vec4<i32>) -> Steps { return half_drift_steps(momentum); }
