// The hits of eight particles among their common candidates, by the prefilter: each lane loads one candidate of eight.
var<private> hits_probe: Probe;
var<private> hits_middle: Middle;

fn prepare_hits(row: u32, me: Particle) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
}
fn hits_of_cluster(row: u32, index: u32, lane: u32, s: Stretches, base: u32, end: u32) -> u32 {
    var mask = 0u;
    for (var part = 0u; part < 32u && base + part < end; part += 8u) {
        let candidate = candidate_probe(resolve(s, min(base + part + lane, s.total - 1u)), hits_middle);
        mask |= eight_hits(hits_probe, candidate) << part;
    }
    let left = end - base;
    mask &= select(0xffffffffu, (1u << (left & 31u)) - 1u, left < 32u);
    let own_bit = index - s.own - base;
    mask &= ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
    keep_mask(row, index, base / 32u, mask);
    return mask;
}
