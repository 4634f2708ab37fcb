// Numbers of either sign, rounded alike: a small negative one has no place in the low word as a real number.
fn sum64_of_signed(value: f32) -> Sum64 {
    let magnitude = sum64_of_f32(abs(value));
    if (value >= 0.0) { return magnitude; }
    return sum64_add(~magnitude, Sum64(1u, 0u));
}
