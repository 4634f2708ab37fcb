// Begins the step and finds where each cell begins.
@compute @workgroup_size(SCAN_LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { begin_step(); }
    scan_all_rows(lane);
}
