// Distances of all pairs up to a range, counted into bins, from which the radial distribution function follows.
//
// Slot analyses/counted_pairs: which pairs are counted. The plan chooses `between_walls` where there are walls.
// Default: each from its smaller id.
//
// Slot analyses/partial: the bins that pairs of a species with another are counted in. The plan chooses `between` where a scene names one
// or two species, `all` where it asks for every two. Default: all pairs are counted alike.
override PARTS: u32;    // workgroups that share the rows around the same particles
override HISTOGRAM_RANGE: f32;
var<workgroup> local_bins: array<atomic<u32>, BINS>;

// Counts pairs by their distance, each from its smaller id. One invocation a sorted particle and a part of the rows around it; a
// workgroup counts in its own memory and adds the result to `histogram`. Reads the sorted particles and `cells`.
@compute @workgroup_size(WORKGROUP)
fn count_pairs_by_distance(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    for (var bin = lane; bin < BINS; bin += WORKGROUP) { atomicStore(&local_bins[bin], 0u); }
    workgroupBarrier();
    let share = share_of(linear_workgroup(workgroup));
    let group = share / PARTS;
    let row = group / SEGMENTS;
    if (row < rows()) {
        let end = row_end(row);
        let first = row_begin(row) + (group - row * SEGMENTS) * WORKGROUP;
        for (var index = first + lane; index < end; index += WORKGROUP * SEGMENTS) {
            count_pairs(row, share % PARTS, index);
        }
    }
    workgroupBarrier();
    for (var bin = lane; bin < BINS; bin += WORKGROUP) {
        let found = atomicLoad(&local_bins[bin]);
        if (found > 0u) {
            let before = atomicAdd(&histogram[2u * bin], found);
            if (before + found < before) { atomicAdd(&histogram[2u * bin + 1u], 1u); }
        }
    }
    report_turns(workgroup.x >> 16u);
}

fn counts_pair(position: vec4<u32>, other: vec4<u32>) -> bool { return position.w < other.w; }
fn bins_of_pair() -> u32 { return BINS; }
fn count_in_bin(index: u32, other: u32, bin: u32) { atomicAdd(&local_bins[bin], 1u); }

// Counts the pairs of one particle in its part of the rows.
fn count_pairs(row: u32, part: u32, index: u32) {
    let position = position_at(index);
    if (!is_own(position)) { return; }
    let column = column_of(fraction_of(position));
    for (var across = part; across < SPAN_Y * SPAN_Z; across += PARTS) {
        let other_row = row_at(row, across);
        for (var along = 0u; along < SPAN_X; along++) {
            let other_column = (column + along + CELLS_X - SPAN_X / 2u) % CELLS_X;
            let cell = cell_index(other_row, other_column);
            let cell_end = cell_at(cell + 1u);
            for (var other = cell_at(cell); other < cell_end; other++) {
                let there = position_at(other);
                let d = separation(position, there);
                let bin = u32(sqrt(dot(d, d)) * (f32(bins_of_pair()) / HISTOGRAM_RANGE));
                if (counts_pair(position, there) && bin < bins_of_pair()) { count_in_bin(index, other, bin); }
            }
        }
    }
}
