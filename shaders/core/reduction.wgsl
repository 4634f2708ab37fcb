// Sums over a workgroup, one row of QUANTITIES sums a workgroup.
var<workgroup> lane_sums: array<vec2<u32>, WORKGROUP>;

// Slot core/reduction: adds up `value` over the lanes of a workgroup and stores the sum in row `group` of
// `partial_sums`. All lanes call it. Default: through workgroup memory. The plan of particles chooses `of_eight` where
// workgroups are subgroups of eight lanes.
fn reduce_quantity(group: u32, lane: u32, quantity: u32, value: Sum64) {
    workgroupBarrier();
    lane_sums[lane] = value;
    workgroupBarrier();
    for (var stride = WORKGROUP / 2u; stride > 0u; stride >>= 1u) {
        if (lane < stride) { lane_sums[lane] = sum64_add(lane_sums[lane], lane_sums[lane + stride]); }
        workgroupBarrier();
    }
    if (lane == 0u) { partial_sums[group * QUANTITIES + quantity] = lane_sums[0]; }
}
