// The total momentum, as exact integers. Reads the particles in the order of their ids.
override PARTICLES: u32;
const QUANTITIES: u32 = 3u;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    for (var axis = 0u; axis < QUANTITIES; axis++) {
        var momentum = Sum64(0u);
        if (id < PARTICLES) { momentum = sum64_of_i32(stored_particle(id).momentum[axis]); }
        reduce_quantity(group, lane, axis, momentum);
    }
}
