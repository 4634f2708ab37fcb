// Adds up the workgroups' sums and appends one row, headed by the step, to the samples of a batch.
override QUANTITIES: u32;
override GROUPS: u32;
@group(0) @binding(9) var<storage, read_write> partial_sums: array<vec2<u32>>;
@group(0) @binding(10) var<storage, read_write> samples: array<vec2<u32>>; // rows in the batch and in all, then the rows
var<workgroup> lane_sums: array<vec2<u32>, WORKGROUP>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
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
