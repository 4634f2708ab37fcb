// Visits the pairs that an earlier pass found, eight particles of a row at a time. For subgroups of eight lanes.
override SEGMENTS: u32; // workgroups that share a row

@compute @workgroup_size(8)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(subgroup_invocation_id) lane: u32) {
    let group = linear_workgroup(workgroup, workgroups);
    let row = group / SEGMENTS;
    if (row >= rows()) { return; }
    let row_first = row_begin(row);
    let row_last = row_end(row);
    for (var first = row_first + (group - row * SEGMENTS) * 8u; first < row_last; first += 8u * SEGMENTS) {
        let index = min(first + lane, row_last - 1u);
        let me = sorted[index];
        let s = cluster_stretches(row, lane, column_of(fraction_of(me.position)));
        let slot = unframed_index(row, index);
        var sums = pass_begin(me);
        var word = 0u;
        var base = 0u;
        var mask = kept_mask(slot, 0u, s.total, index - s.own);
        // Words without a hit are rare: a lane that meets one spends a turn on it.
        while (base < s.total) {
            if (mask != 0u) {
                pass_pair(&sums, me, resolve(s, base + firstTrailingBit(mask)));
                mask &= mask - 1u;
            }
            if (mask == 0u) {
                word += 1u;
                base += 32u;
                mask = select(0u, kept_mask(slot, word, s.total - base, index - s.own - base), base < s.total);
            }
        }
        if (first + lane < row_last) { pass_end(row, index, me, sums); }
    }
}
