// An exclusive prefix sum over the lanes of a workgroup, of two sums at once.
var<workgroup> scan_lanes: array<vec2<u32>, SCAN_LANES>;

fn scan_of_lanes(lane: u32, value: vec2<u32>) -> vec2<u32> {
    scan_lanes[lane] = value;
    workgroupBarrier();
    for (var stride = 1u; stride < SCAN_LANES; stride <<= 1u) {
        let earlier = select(vec2<u32>(0u), scan_lanes[max(lane, stride) - stride], lane >= stride);
        workgroupBarrier();
        scan_lanes[lane] += earlier;
        workgroupBarrier();
    }
    return scan_lanes[lane] - value;
}
