// Sums by shuffles over the eight lanes of a workgroup that is one subgroup.
fn reduce_quantity(group: u32, lane: u32, quantity: u32, value: Sum64) {
    var sum = value;
    for (var distance = 4u; distance > 0u; distance >>= 1u) {
        sum = sum64_add(sum, subgroupShuffle(sum, lane ^ distance));
    }
    if (lane == 0u) { partial_sums[group * QUANTITIES + quantity] = sum; }
}
