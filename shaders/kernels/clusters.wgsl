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
    let row_first = row_begin(row);
    let row_last = row_end(row);
    var masks: array<u32, WORDS>;
    var bases: array<u32, WORDS>;
    for (var first = row_first + (group - row * SEGMENTS) * 8u; first < row_last; first += 8u * SEGMENTS) {
        let index = min(first + lane, row_last - 1u);
        let me = particle_at(index);
        let s = cluster_stretches(row, lane, column_of(fraction_of(me.position)));
        prepare_hits(row, me);
        var sums = pass_begin(me);
        for (var tile = 0u; tile < s.total; tile += 32u * WORDS) {
            let tile_end = min(s.total, tile + 32u * WORDS);
            var filled = 0u;
            for (var base = tile; base < tile_end; base += 32u) {
                let mask = hits_of_cluster(row, index, lane, s, base, tile_end);
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
    pass_finish(group, lane);
}
