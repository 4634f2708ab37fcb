// The hits of eight particles among their common candidates, as an earlier pass found them.
fn prepare_hits(row: u32, me: Particle, lane: u32, s: Stretches) {}
fn hits_of_cluster(row: u32, index: u32, lane: u32, s: Stretches, base: u32, end: u32) -> u32 {
    return kept_mask(unframed_index(row, index), base / 32u, end - base, index - s.own - base);
}
