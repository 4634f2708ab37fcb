// Visits the pairs that an earlier pass found, one invocation a particle. For any subgroup size.
override SEGMENTS: u32; // workgroups that share a row

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup, workgroups);
    let row = group / SEGMENTS;
    if (row < rows()) {
        let end = row_end(row);
        for (var index = row_begin(row) + (group - row * SEGMENTS) * 64u + lane; index < end; index += 64u * SEGMENTS) {
            visit(row, index);
        }
    }
    pass_finish(group, lane);
}

fn visit(row: u32, index: u32) {
    let me = sorted[index];
    let column = column_of(fraction_of(me.position));
    let last_column = column + 2u * frame();
    let slot = unframed_index(row, index);
    var sums = pass_begin(me);
    var word = 0u;
    var neighbour = 0u;
    var base = 0u;
    var end = 0u;
    var mask = 0u;
    var mask_base = 0u;
    // One loop over pairs and words, so that lanes with a short row need not wait for lanes with a long one.
    loop {
        if (mask == 0u) {
            if (base >= end) {
                if (neighbour == neighbour_rows()) { break; }
                let start = neighbour_row(row, neighbour) * row_width();
                base = cells[start + column];
                end = cells[start + last_column + 1u];
                neighbour += 1u;
                continue;
            }
            mask = kept_mask(slot, word, min(32u, end - base), index - base);
            mask_base = base;
            word += 1u;
            base += 32u;
            continue;
        }
        pass_pair(&sums, me, mask_base + firstTrailingBit(mask));
        mask &= mask - 1u;
    }
    pass_end(row, index, me, sums);
}
