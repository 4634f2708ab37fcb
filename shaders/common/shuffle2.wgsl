// Hits of one probe against the eight that the lanes of a subgroup hold.
fn shuffled(probe: Probe, lane: u32) -> Probe {
    return Probe(subgroupShuffle(probe.x, lane), subgroupShuffle(probe.y, lane));
}
