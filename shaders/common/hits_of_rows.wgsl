// The hits of a particle among a stretch of candidates, by the prefilter.
var<private> hits_probe: Probe;
var<private> hits_middle: Middle;

fn prepare_hits(row: u32, me: Particle) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
}
fn hits_of_row(row: u32, index: u32, word: u32, base: u32, count: u32) -> u32 {
    var mask = 0u;
    for (var bit = 0u; bit < count; bit++) {
        mask |= select(0u, 1u << bit, probe_hits(hits_probe, candidate_probe(base + bit, hits_middle)));
    }
    let own = index - base;
    mask &= ~select(0u, 1u << (own & 31u), own < 32u);
    keep_mask(row, index, word, mask);
    return mask;
}
