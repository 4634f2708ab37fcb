// Follows particles of shallow water that lie in one array on their ways round the box.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let particle = stored(index);
    follow(particle.id, vec4<u32>(particle.position, 0u, 0u));
}
