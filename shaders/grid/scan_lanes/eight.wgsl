// An exclusive prefix sum over the eight lanes of a subgroup, by shuffles.
fn scan_of_lanes(lane: u32, value: vec2<u32>) -> vec2<u32> {
    var sum = value;
    sum += sum_of_earlier(lane, sum, 1u);
    sum += sum_of_earlier(lane, sum, 2u);
    sum += sum_of_earlier(lane, sum, 4u);
    return sum - value;
}
fn sum_of_earlier(lane: u32, sum: vec2<u32>, distance: u32) -> vec2<u32> {
    let earlier = (lane - distance) & 7u;
    return select(vec2<u32>(0u), vec2<u32>(subgroupShuffle(sum.x, earlier), subgroupShuffle(sum.y, earlier)), lane >= distance);
}
