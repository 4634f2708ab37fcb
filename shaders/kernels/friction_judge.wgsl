// Adds up the sums of an iteration, and leaves the kernels of the next without workgroups if none is needed.
@group(0) @binding(38) var<storage, read_write> demands: array<u32>; // workgroups of an iteration, as they are and as needed
// Whether this iteration is needed, for all lanes alike: what lies in storage may look different to each.
var<workgroup> running: u32;

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { running = solver.running; }
    if (workgroupUniformLoad(&running) == 0u) { return; }
    var own = vec4<f32>(0.0);
    for (var group = lane; group < CELL_GROUPS; group += LANES) { own += solver.sums[group]; }
    let sums = sum_of_lanes(lane, own);
    if (lane == 0u) {
        judge(sums);
        if (solver.running == 0u) {
            for (var axis = 0u; axis < 3u; axis++) { demands[3u + axis] = 0u; }
        }
    }
}
