// Implicit friction by conjugate gradients: Chronopoulos and Gear, doi:10.1016/0377-0427(89)90045-9, whose iterations need a
// single sum over all cells. Sums are of single precision, in an order that depends on nothing but where the cells are.
//
// The equations of Crank and Nicolson's friction: for the mean W of the velocities U before and after it,
// (2M + dt G) W = 2MU + J with the friction G and the random impulses J. For few cells one workgroup makes all iterations
// (`friction_solve`); else every iteration is two kernels, three for very many cells (src/families/voronoi/plan/friction.rs).
override CELL_GROUPS: u32; // workgroups that sum the right-hand side
override FIRST_SUM: u32;   // the sums that `friction_step` adds up: those of all workgroups, or their total
override SUMS: u32;
override TOLERANCE: f32;
override ITERATIONS: u32;

// How far the iterations have come.
struct Progress {
    iterations: u32,
    running: u32,     // 1 as long as the residual is too large
    step_length: f32, // along the direction of search
    turn: f32,        // part of the last direction in the next
    square: f32,      // of the residual, in the norm of the preconditioner
    scale: f32,       // the same of the right-hand side
    residual: f32,    // relative to that
}

struct Solver {
    key: vec2<u32>,   // of the step's random words
    now: Progress,
    next: Progress,   // after the step along the direction of search, where iterations are kernels
    sums: array<vec4<f32>>, // of each workgroup: squares of residual, its image, and the right-hand side; then their total
}

// `preconditioners` holds the inverse of a cell's own block of the equations, and 2M; `images` the image of each search, where
// iterations are kernels; `directions` the last direction of search of a cell and its image, and in `friction_solve` images follow
// directions.

// What neighbours read of a cell in an iteration. Its place is kept as words: their bits might not survive as a real number.
struct Search { residual: Vector, place: Fraction } // the preconditioned residual

// Sums of single precision over a workgroup, always in the same order.
const LANES: u32 = 64u;
var<workgroup> solver_lane_sums: array<vec4<f32>, LANES>;

fn sum_of_lanes(lane: u32, value: vec4<f32>) -> vec4<f32> {
    solver_lane_sums[lane] = value;
    workgroupBarrier();
    for (var stride = LANES / 2u; stride > 0u; stride >>= 1u) {
        if (lane < stride) { solver_lane_sums[lane] += solver_lane_sums[lane + stride]; }
        workgroupBarrier();
    }
    return solver_lane_sums[0];
}

// The progress that all lanes of a workgroup see alike: what lies in storage may look different to each.
var<workgroup> solver_progress: Progress;

// The inverse of a cell's own 2 by 2 block of the equations, xx, xy, yy, times a vector.
fn preconditioned(inverse: vec3<f32>, v: Vector) -> Vector {
    return Vector(inverse.x * v.x + inverse.y * v.y, inverse.y * v.x + inverse.z * v.y);
}

// The image of the preconditioned residual (voronoi/visit/image).
fn image_of_search(slot: u32, mine: Search) -> Vector {
    var visit = Visit(mine, preconditioners[slot].w * mine.residual);
    visit_faces(slot, &visit);
    return visit.image;
}
// What a cell adds to the sums of an iteration.
fn products_of(slot: u32, mine: Search, image: Vector) -> vec4<f32> {
    return vec4<f32>(dot(estimates[slot].zw, mine.residual), dot(image, mine.residual), 0.0, 0.0);
}
// A step along the direction of search, from the last one with its image, which is returned.
fn step_along(slot: u32, progress: Progress, image: Vector, last: vec4<f32>) -> vec4<f32> {
    let search = searches[slot];
    // What an earlier step has left need not be a number.
    let turned = select(vec4<f32>(0.0), progress.turn * last, progress.turn != 0.0);
    let direction = vec4<f32>(search.residual, image) + turned;
    let length = vec4<f32>(vec2<f32>(progress.step_length), vec2<f32>(-progress.step_length));
    let estimate = estimates[slot] + length * direction;
    estimates[slot] = estimate;
    searches[slot] = Search(preconditioned(preconditioners[slot].xyz, estimate.zw), search.place);
    return direction;
}

// Whether another iteration is needed, and how far it goes.
fn judged(before: Progress, sums: vec4<f32>) -> Progress {
    var progress = before;
    let first = before.iterations == 0u;
    if (first) { progress.scale = sums.z; }
    let square = sums.x;
    let turn = select(square / before.square, 0.0, first);
    let curvature = sums.y - select(turn * square / before.step_length, 0.0, first);
    progress.residual = select(0.0, sqrt(square / progress.scale), square > 0.0);
    // What is not a number ends the iterations too.
    let numbers = is_number(square) && is_number(curvature);
    let is_needed = square > TOLERANCE * TOLERANCE * progress.scale;
    if (numbers && before.iterations < ITERATIONS && is_needed && curvature > 0.0) {
        progress.square = square;
        progress.turn = turn;
        progress.step_length = square / curvature;
        progress.iterations += 1u;
    } else {
        progress.running = 0u;
    }
    return progress;
}

// Sets up the equations of a cell (voronoi/visit/equations); returns the square of the right-hand side.
fn set_up(slot: u32) -> f32 {
    prepare_noise();
    let me = stored_particle(slot);
    let velocity = velocity_of(me);
    let inertia = 2.0 * mass_of(me);
    var visit =
        Visit(me, velocity, temperature_of(me), Vector(0.0), Vector(0.0), vec3<f32>(inertia, 0.0, inertia));
    visit_faces(slot, &visit);
    let block = visit.block;
    let inverse = vec3<f32>(block.z, -block.y, block.x) / (block.x * block.z - block.y * block.y);
    let residual = visit.friction + visit.noise;
    preconditioners[slot] = vec4<f32>(inverse, inertia);
    estimates[slot] = vec4<f32>(velocity, residual);
    searches[slot] = Search(preconditioned(inverse, residual), me.position.xy);
    let right = inertia * velocity + visit.noise;
    return dot(right, preconditioned(inverse, right));
}

// Begins to solve for the velocities after friction. One invocation; writes `solver`.
@compute @workgroup_size(1)
fn friction_begin() {
    solver.key = clock_key();
    let progress = Progress(0u, 1u, 0.0, 0.0, 0.0, 0.0, 0.0);
    solver.now = progress;
    solver.next = progress;
}

// Sets up the equations; the velocities before friction are the first guess. One invocation a cell; reads particles and faces,
// writes `preconditioners`, `estimates`, `searches` and the sums of the right-hand side.
@compute @workgroup_size(LANES)
fn friction_setup(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * LANES + lane;
    var square = 0.0;
    if (slot < PARTICLES) { square = set_up(slot); }
    let sum = sum_of_lanes(lane, vec4<f32>(0.0, 0.0, square, 0.0));
    if (lane == 0u && group * LANES < max(PARTICLES, 1u)) { solver.sums[group] = sum; }
}

// All iterations in one workgroup: for few cells computing costs less than dispatching. A lane takes every 64th cell; updates
// `estimates`, `searches` and `directions`.
@compute @workgroup_size(LANES)
fn friction_solve(@builtin(local_invocation_index) lane: u32) {
    var right = 0.0;
    for (var group = lane; group < CELL_GROUPS; group += LANES) { right += solver.sums[group].z; }
    for (var round_number = 0u; round_number <= ITERATIONS; round_number++) {
        var products = vec4<f32>(0.0, 0.0, right, 0.0);
        for (var slot = lane; slot < PARTICLES; slot += LANES) {
            let mine = searches[slot];
            let image = image_of_search(slot, mine);
            directions[PARTICLES + slot] = vec4<f32>(image, 0.0, 0.0);
            products += products_of(slot, mine, image);
        }
        let sums = sum_of_lanes(lane, products);
        if (lane == 0u) {
            solver_progress = judged(solver.now, sums);
            solver.now = solver_progress;
        }
        storageBarrier();
        let progress = workgroupUniformLoad(&solver_progress);
        if (progress.running == 0u) { break; }
        for (var slot = lane; slot < PARTICLES; slot += LANES) {
            directions[slot] = step_along(slot, progress, directions[PARTICLES + slot].xy, directions[slot]);
        }
        storageBarrier();
    }
}

// The first part of an iteration: images of the preconditioned residuals, and the sums that it needs. One invocation a cell;
// reads `searches` and faces, writes `images` and `solver`.
@compute @workgroup_size(LANES)
fn friction_image(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { solver_progress = solver.next; }
    let progress = workgroupUniformLoad(&solver_progress);
    let group = linear_workgroup(workgroup);
    if (lane == 0u && group == 0u) { solver.now = progress; }
    if (progress.running == 0u) { return; }
    let slot = group * LANES + lane;
    var products = vec4<f32>(0.0);
    if (slot < PARTICLES) {
        let mine = searches[slot];
        let image = image_of_search(slot, mine);
        images[slot] = image;
        products = products_of(slot, mine, image);
    }
    let sum = sum_of_lanes(lane, products);
    // The sum of the right-hand side stays.
    if (lane == 0u && group * LANES < max(PARTICLES, 1u)) { solver.sums[group] = vec4<f32>(sum.xy, solver.sums[group].zw); }
}

// The sum of some sums of workgroups.
fn sum_of_groups(lane: u32, first: u32, count: u32) -> vec4<f32> {
    var own = vec4<f32>(0.0);
    for (var group = lane; group < count; group += LANES) { own += solver.sums[first + group]; }
    return sum_of_lanes(lane, own);
}

// The second part where cells are so many that not every workgroup should add up all sums. One workgroup; updates `solver`.
@compute @workgroup_size(LANES)
fn friction_total(@builtin(local_invocation_index) lane: u32) {
    let sums = sum_of_groups(lane, 0u, CELL_GROUPS);
    if (lane == 0u) { solver.sums[CELL_GROUPS] = sums; }
}

// The last part: a step along the direction of search, if one is needed, which every workgroup finds for itself. One invocation a
// cell; updates `estimates`, `searches`, `directions` and `solver`.
@compute @workgroup_size(LANES)
fn friction_step(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { solver_progress = solver.now; }
    let before = workgroupUniformLoad(&solver_progress);
    if (before.running == 0u) { return; }
    let sums = sum_of_groups(lane, FIRST_SUM, SUMS);
    if (lane == 0u) { solver_progress = judged(before, sums); }
    let progress = workgroupUniformLoad(&solver_progress);
    let group = linear_workgroup(workgroup);
    if (lane == 0u && group == 0u) { solver.next = progress; }
    let slot = group * LANES + lane;
    if (progress.running == 0u || slot >= PARTICLES) { return; }
    directions[slot] = step_along(slot, progress, images[slot], directions[slot]);
}

// The end of all iterations that were recorded: the residual that is left, and the failure if more iterations are allowed and
// needed. One workgroup; updates `solver`.
@compute @workgroup_size(LANES)
fn friction_end(@builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) { solver_progress = solver.now; }
    if (workgroupUniformLoad(&solver_progress).running == 0u) { return; }
    let sums = sum_of_groups(lane, 0u, CELL_GROUPS);
    if (lane == 0u) {
        let progress = judged(solver.now, sums);
        raise(select(0u, FAILURE_ITERATIONS, progress.running != 0u));
        solver.now = progress;
    }
}
