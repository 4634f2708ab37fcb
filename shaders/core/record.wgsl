// Adds up the workgroups' sums and appends one row, headed by the step, to the samples of a batch.
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

// Appends the histogram as one row, headed by the step, to the samples of a batch, and clears it.
var<storage, read_write> histogram: array<vec2<u32>>;

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
