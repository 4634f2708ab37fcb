// 64-bit integer sums from 32-bit words, low word first: unlike sums of f32 they do not depend on the order.
alias Sum64 = vec2<u32>;

fn sum64_add(a: Sum64, b: Sum64) -> Sum64 {
    let low = a.x + b.x;
    return Sum64(low, a.y + b.y + select(0u, 1u, low < a.x));
}
fn sum64_of_i32(value: i32) -> Sum64 { return Sum64(bitcast<u32>(value), bitcast<u32>(value >> 31u)); }
// The nearest integer of a number of magnitude under 2^63.
fn sum64_of_f32(value: f32) -> Sum64 {
    let whole = round(value);
    let high = floor(whole * 2.3283064e-10); // 2^-32
    let low = whole - high * 4294967296.0;
    return Sum64(u32(low), bitcast<u32>(i32(high)));
}
// The same for a number of either sign, rounded alike: a small negative number would lose digits in the low word.
fn sum64_of_signed(value: f32) -> Sum64 {
    let magnitude = sum64_of_f32(abs(value));
    if (value >= 0.0) { return magnitude; }
    return sum64_add(~magnitude, Sum64(1u, 0u));
}
