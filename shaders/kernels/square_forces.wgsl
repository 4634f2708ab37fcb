// The squares of the conservative forces, once all couplings have added theirs.
override PARTICLES: u32;
override GRADIENT: f32; // square of the force per square of an impulse, over its quantum
@group(0) @binding(39) var<storage, read_write> forces: array<vec4<i32>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) {
        let force = Vector(steps_of(forces[slot]));
        forces[slot] = vec4<i32>(0);
        total_add(7u, sum64_of_f32(dot(force, force) * GRADIENT));
    }
    total_reduce(group, lane);
}
