// Histograms of a value of each particle in bins of equal width, with sums of its powers. Values outside the bins have entries of
// their own; particles so far outside that their powers would leave the range of integers are counted separately.
//
// Slot analyses/sampled: the vector of a particle, by id, in the units of the plan; components beyond the box's dimension are
// zero. Variants velocity, momentum, force, acceleration, and peculiar_velocity where shear has momenta in the box; the plan
// follows the analysis (src/run/analyses/planner.rs). No default.
// Slot analyses/counted: which values of the vector are counted. Variants components, magnitude; the same plan chooses. No
// default.
override COUNTS: u32;       // the bins; then below, above, and, of particles, far beyond
override HALF_BINS: f32;    // half bins per unit of what is sampled
override HALF_BELOW: i32;   // half bins below zero
override FRACTION: f32;     // of the range, per unit of what is sampled
override MOMENT: f32;       // reciprocal of the quantum of the powers
const MOMENTS: u32 = 5u;    // of the value: first, second, fourth power; of the vector: second, fourth
const FARTHEST: f32 = 8.0;  // in ranges
var<workgroup> local_counts: array<atomic<u32>, COUNTS>;
var<workgroup> local_moments: array<atomic<u32>, 2u * MOMENTS>;

// Counts the particles of a workgroup in its own memory, and adds the result to `histogram`. One invocation several particles, by
// id, GROUPS * WORKGROUP apart.
@compute @workgroup_size(WORKGROUP)
fn count_histogram(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    for (var entry = lane; entry < COUNTS; entry += WORKGROUP) { atomicStore(&local_counts[entry], 0u); }
    for (var word = lane; word < 2u * MOMENTS; word += WORKGROUP) { atomicStore(&local_moments[word], 0u); }
    workgroupBarrier();
    let group = linear_workgroup(workgroup);
    // The dispatch may be folded, and then has a few workgroups too many.
    if (group < GROUPS) {
        for (var id = group * WORKGROUP + lane; id < PARTICLES; id += GROUPS * WORKGROUP) {
            if (is_measured(id)) { count_vector(sampled(id)); }
        }
    }
    workgroupBarrier();
    for (var entry = lane; entry < COUNTS; entry += WORKGROUP) {
        add_global(entry, Sum64(atomicLoad(&local_counts[entry]), 0u));
    }
    for (var moment = lane; moment < MOMENTS; moment += WORKGROUP) {
        let low = atomicLoad(&local_moments[2u * moment]);
        add_global(COUNTS + moment, Sum64(low, atomicLoad(&local_moments[2u * moment + 1u])));
    }
}

// Counts the values of one particle.
fn count_vector(vector: vec3<f32>) {
    let place = vector * FRACTION;
    let square = dot(place, place);
    let far = square > FARTHEST * FARTHEST;
    if (far) { atomicAdd(&local_counts[BINS + 2u], 1u); }
    for (var axis = FIRST_AXIS; axis < END_AXIS; axis++) {
        let value = counted(vector, axis);
        // In half bins, so that zero is an edge or the middle of a bin without a sum that could be rounded.
        let limit = f32(BINS) * 4.0;
        let half_bin = HALF_BELOW + i32(floor(clamp(value * HALF_BINS, -limit, limit)));
        let bin = u32(clamp(half_bin >> 1u, 0, i32(BINS) - 1));
        let beyond = select(BINS, BINS + 1u, half_bin >= 2 * i32(BINS));
        let inside = half_bin >= 0 && half_bin < 2 * i32(BINS);
        atomicAdd(&local_counts[select(beyond, bin, inside)], 1u);
        if (!far) {
            let part = counted(place, axis);
            add_local(0u, part);
            add_local(1u, part * part);
            add_local(2u, part * part * part * part);
        }
    }
    if (!far) {
        add_local(3u, square);
        add_local(4u, square * square);
    }
}

fn add_local(moment: u32, value: f32) {
    let sum = sum64_of_signed(value * MOMENT);
    let before = atomicAdd(&local_moments[2u * moment], sum.x);
    atomicAdd(&local_moments[2u * moment + 1u], sum.y + select(0u, 1u, before + sum.x < before));
}
fn add_global(entry: u32, sum: Sum64) {
    if (all(sum == Sum64(0u))) { return; }
    let before = atomicAdd(&histogram[2u * entry], sum.x);
    atomicAdd(&histogram[2u * entry + 1u], sum.y + select(0u, 1u, before + sum.x < before));
}
