// Visits every pair from both ends, eight particles of a row at a time: the lanes of a subgroup of eight share the
// loading of candidates and hand them round by shuffles. For adapters whose subgroups have eight lanes.
override SEGMENTS: u32; // workgroups that share a row

const WORDS: u32 = 32u;

@compute @workgroup_size(8)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(subgroup_invocation_id) lane: u32) {
    let group = linear_workgroup(workgroup, workgroups);
    let row = group / SEGMENTS;
    if (row >= rows()) { return; }
    let middle = row_middle(row);
    let row_first = row_begin(row);
    let row_last = row_end(row);
    var masks: array<u32, WORDS>;
    var bases: array<u32, WORDS>;
    for (var first = row_first + (group - row * SEGMENTS) * 8u; first < row_last; first += 8u * SEGMENTS) {
        let index = min(first + lane, row_last - 1u);
        let me = sorted[index];
        let fraction = fraction_of(me.position);
        let probe = probe_of(fraction, middle);
        let s = cluster_stretches(row, lane, column_of(fraction));
        var sums = pass_begin(me);
        for (var tile = 0u; tile < s.total; tile += 32u * WORDS) {
            let tile_end = min(s.total, tile + 32u * WORDS);
            var filled = 0u;
            for (var base = tile; base < tile_end; base += 32u) {
                var mask = 0u;
                for (var part = 0u; part < 32u && base + part < tile_end; part += 8u) {
                    let word = probes[resolve(s, min(base + part + lane, s.total - 1u))];
                    mask |= eight_hits(probe, probe_of_word(word, middle)) << part;
                }
                let left = tile_end - base;
                mask &= select(0xffffffffu, (1u << (left & 31u)) - 1u, left < 32u);
                let own_bit = index - s.own - base;
                mask &= ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
                keep_mask(row, index, base / 32u, mask);
                masks[filled] = mask;
                bases[filled] = base;
                filled += select(0u, 1u, mask != 0u);
            }
            var word = 0u;
            var mask = masks[0];
            var word_base = bases[0];
            while (word < filled) {
                let other = resolve(s, word_base + firstTrailingBit(mask));
                mask &= mask - 1u;
                pass_pair(&sums, me, other);
                if (mask == 0u) {
                    word += 1u;
                    mask = masks[word & 31u];
                    word_base = bases[word & 31u];
                }
            }
        }
        if (first + lane < row_last) { pass_end(row, index, me, sums); }
    }
}
