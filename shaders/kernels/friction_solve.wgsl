// All iterations in one workgroup: of few cells there is less to compute than to dispatch.
override PARTICLES: u32;
@group(0) @binding(25) var<storage, read_write> directions: array<vec4<f32>>; // of search, and its image; images behind them
// Whether another iteration is needed, for all lanes alike: what lies in storage may look different to each.
var<workgroup> running: u32;

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    var right = 0.0;
    for (var group = lane; group < CELL_GROUPS; group += LANES) { right += solver.sums[group].z; }
    for (var iteration = 0u; iteration <= ITERATIONS; iteration++) {
        var products = vec4<f32>(0.0, 0.0, right, 0.0);
        for (var slot = lane; slot < PARTICLES; slot += LANES) {
            let mine = searches[slot];
            let image = image_of_search(slot, mine);
            directions[PARTICLES + slot] = vec4<f32>(image, 0.0, 0.0);
            products += products_of(slot, mine, image);
        }
        let sums = sum_of_lanes(lane, products);
        if (lane == 0u) {
            judge(sums);
            running = solver.running;
        }
        storageBarrier();
        if (workgroupUniformLoad(&running) == 0u) { break; }
        for (var slot = lane; slot < PARTICLES; slot += LANES) {
            directions[slot] = step_along(slot, directions[PARTICLES + slot].xy, directions[slot]);
        }
        storageBarrier();
    }
}
