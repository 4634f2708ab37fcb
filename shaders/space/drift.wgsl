// What the sums of impulses hold.
const IMPULSE_LIMIT: f32 = 134217728.0; // 2^27 units: several of them still fit

// Whether every component is a number smaller than a limit, whatever its sign: see `is_within`.
fn all_within(v: Vector, limit: f32) -> bool {
    return all((bitcast<Fraction>(v) & Fraction(0x7fffffffu)) < Fraction(bitcast<u32>(limit)));
}

// The drift of one step, rounded once to fractions of the box.
fn drift_steps(momentum: vec4<i32>) -> Steps {
    return Steps(round(Vector(steps_of(momentum)) * (drift_of(species_in(momentum)) / unit_lengths())));
}
