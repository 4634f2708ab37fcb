// Appends what a report or an analysis has summed as a row to the samples of a batch, headed by the step.

// Adds up the rows of `partial_sums` of all workgroups and appends one row of QUANTITIES sums to `samples`. One workgroup; its
// lanes share the rows, and lane 0 adds up what they have found.
@compute @workgroup_size(WORKGROUP)
fn record_sample(@builtin(local_invocation_index) lane: u32) {
    let row = 1u + samples[0].x * (QUANTITIES + 1u);
    for (var quantity = 0u; quantity < QUANTITIES; quantity++) {
        var own = Sum64(0u);
        for (var group = lane; group < GROUPS; group += WORKGROUP) {
            own = sum64_add(own, partial_sums[group * QUANTITIES + quantity]);
        }
        workgroupBarrier();
        lane_sums[lane] = own;
        workgroupBarrier();
        if (lane == 0u) {
            var total = Sum64(0u);
            for (var k = 0u; k < WORKGROUP; k++) { total = sum64_add(total, lane_sums[k]); }
            samples[row + 1u + quantity] = total;
        }
    }
    workgroupBarrier();
    if (lane == 0u) {
        samples[row] = control.step;
        samples[0] += vec2<u32>(1u);
    }
}

// What an analysis has counted, 64-bit integers.
var<storage, read_write> histogram: array<vec2<u32>>;

// Appends the histogram as one row to `samples`, and clears it. One workgroup; a lane copies every WORKGROUP-th bin.
@compute @workgroup_size(WORKGROUP)
fn record_histogram(@builtin(local_invocation_index) lane: u32) {
    let row = 1u + samples[0].x * (BINS + 1u);
    for (var bin = lane; bin < BINS; bin += WORKGROUP) {
        samples[row + 1u + bin] = histogram[bin];
        histogram[bin] = vec2<u32>(0u);
    }
    storageBarrier();
    workgroupBarrier();
    if (lane == 0u) {
        samples[row] = control.step;
        samples[0] += vec2<u32>(1u);
    }
}
