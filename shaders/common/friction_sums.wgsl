// Sums of single precision over a workgroup, always in the same order.
const LANES: u32 = 64u;
var<workgroup> lane_sums: array<vec4<f32>, LANES>;

fn sum_of_lanes(lane: u32, value: vec4<f32>) -> vec4<f32> {
    lane_sums[lane] = value;
    workgroupBarrier();
    for (var stride = LANES / 2u; stride > 0u; stride >>= 1u) {
        if (lane < stride) { lane_sums[lane] += lane_sums[lane + stride]; }
        workgroupBarrier();
    }
    return lane_sums[0];
}
