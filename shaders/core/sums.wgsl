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

override FIRST_GROUP: u32; // rows of partial sums that belong to the kernels before this one
// What a kernel of a report adds up, each in integers of a unit that the plan states: 0 kinetic energy, 1 virial of all forces,
// 2 to 4 momentum, 5 potential energy, 6 virial of the conservative forces, 7 squared force, 8 curvature; 9 energy, 10 square and
// 11 number of baths with memory; of oscillators 12 to 14 the products of bath, momentum and displacement; last what walls have taken up
// and what body forces have given, which kernels of their own tell.
var<private> report_totals: array<vec2<u32>, REPORTED>;
// Slot core/reported: the most sums of a report. Default: without walls and products. The plan chooses `with_walls` if there are walls, or
// shear, and `with_products` of oscillators.
const REPORTED: u32 = 16u;

fn total_add(quantity: u32, value: Sum64) { report_totals[quantity] = sum64_add(report_totals[quantity], value); }
fn total_reduce(group: u32, lane: u32) {
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        reduce_quantity(FIRST_GROUP + group, lane, quantity, report_totals[quantity]);
    }
}
fn observe_bath(energy: f32, square: f32) {
    total_add(9u, sum64_of_f32(energy));
    total_add(10u, sum64_of_f32(square));
    total_add(11u, Sum64(1u, 0u));
}
