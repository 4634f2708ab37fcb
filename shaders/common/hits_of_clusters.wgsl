// The hits of eight particles among their common candidates, by the prefilter: each lane loads one candidate of eight.
var<private> hits_probe: Probe;
var<private> hits_middle: Middle;
var<private> hits_next: Probe; // the candidate of this lane among the next eight, loaded while others are looked at

fn prepare_hits(row: u32, me: Particle, lane: u32, s: Stretches) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
    hits_next = candidate_of_lane(s, lane);
}
fn candidate_of_lane(s: Stretches, candidate: u32) -> Probe {
    return candidate_probe(resolve(s, min(candidate, s.total - 1u)), hits_middle);
}
fn hits_of_cluster(row: u32, index: u32, lane: u32, s: Stretches, base: u32, end: u32) -> u32 {
    var mask = 0u;
    var part = 0u;
    loop {
        let next = candidate_of_lane(s, base + part + 8u + lane);
        mask |= eight_hits(hits_probe, lane, hits_next) << part;
        hits_next = next;
        part += 8u;
        if (part >= 32u || base + part >= end) { break; }
    }
    let left = end - base;
    mask &= select(0xffffffffu, (1u << (left & 31u)) - 1u, left < 32u);
    let own_bit = index - s.own - base;
    mask &= ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
    keep_mask(row, index, base / 32u, mask);
    return mask;
}
