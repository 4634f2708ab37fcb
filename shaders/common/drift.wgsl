// The drift of one step, rounded once to fractions of the box.
fn drift_steps(momentum: vec4<i32>) -> Steps {
    return Steps(round(Vector(steps_of(momentum)) * (drift_of(species_in(momentum)) / unit_lengths())));
}
