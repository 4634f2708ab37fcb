// Appends the histogram as one row, headed by the step, to the samples of a batch, and clears it.
override BINS: u32;
@group(0) @binding(8) var<storage, read_write> histogram: array<vec2<u32>>;
@group(0) @binding(10) var<storage, read_write> samples: array<vec2<u32>>; // rows in the batch and in all, then the rows

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
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
