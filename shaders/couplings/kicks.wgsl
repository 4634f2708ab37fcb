// The squares of the conservative forces, once all couplings have added theirs.
var<storage, read_write> forces: array<vec4<i32>>;

@compute @workgroup_size(WORKGROUP)
fn square_forces(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) {
        let force = Vector(steps_of(forces[slot]));
        forces[slot] = vec4<i32>(0);
        total_add(7u, sum64_of_f32(dot(force, force) * GRADIENT));
    }
    total_reduce(group, lane);
}

// No force of this scene is conservative.
fn add_force(slot: u32, force: Steps) {}
