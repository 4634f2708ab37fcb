// The velocity of the centre of mass of the particles that can move, for analyses that are relative to it.

// Sums their momenta as exact integers. One invocation a particle, by id; writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn sum_momenta(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    for (var axis = 0u; axis < QUANTITIES; axis++) {
        var momentum = Sum64(0u);
        if (is_measured(id)) { momentum = sum64_of_i32(stored_particle(id).momentum[axis]); }
        reduce_quantity(group, lane, axis, momentum);
    }
}

override INVERSE_TOTAL_MASS: f32;

// Adds up the rows of `partial_sums` and divides by their mass. One workgroup; writes `centre`.
@compute @workgroup_size(WORKGROUP)
fn find_centre(@builtin(local_invocation_index) lane: u32) {
    for (var axis = 0u; axis < 3u; axis++) {
        var own = Sum64(0u);
        for (var group = lane; group < GROUPS; group += WORKGROUP) {
            own = sum64_add(own, partial_sums[group * 3u + axis]);
        }
        workgroupBarrier();
        lane_sums[lane] = own;
        workgroupBarrier();
        if (lane == 0u) {
            var total = Sum64(0u);
            for (var k = 0u; k < WORKGROUP; k++) { total = sum64_add(total, lane_sums[k]); }
            let negative = (total.y >> 31u) == 1u;
            if (negative) { total = sum64_add(~total, Sum64(1u, 0u)); }
            let magnitude = (f32(total.y) * 4294967296.0 + f32(total.x)) * INVERSE_TOTAL_MASS;
            centre[0][axis] = select(magnitude, -magnitude, negative);
        }
    }
}

// Slot analyses/frame: the frame in which velocities are sampled.
// Default: that of the box. The plan chooses `centre_of_mass` if the scene says so, or by default where momentum is not
// conserved.
fn in_frame(velocity: vec3<f32>) -> vec3<f32> { return velocity; }
