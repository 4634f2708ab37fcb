// What a kernel of a report adds up, each in integers of a unit that the plan states: kinetic energy, virial of all forces,
// three components of momentum, potential energy, virial of the conservative forces, squared force, curvature; energy,
// square and number of baths with memory.
override QUANTITIES: u32;
override FIRST_GROUP: u32; // rows of partial sums that belong to the kernels before this one
var<private> totals: array<vec2<u32>, 12>;

fn total_add(quantity: u32, value: Sum64) { totals[quantity] = sum64_add(totals[quantity], value); }
fn total_reduce(group: u32, lane: u32) {
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        reduce_quantity(FIRST_GROUP + group, lane, quantity, totals[quantity]);
    }
}
fn observe_bath(energy: f32, square: f32) {
    total_add(9u, sum64_of_f32(energy));
    total_add(10u, sum64_of_f32(square));
    total_add(11u, Sum64(1u, 0u));
}
