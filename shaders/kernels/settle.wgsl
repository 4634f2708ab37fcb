// Makes the new order of the particles the one that counts.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    store_particle(slot, particle_at(slot));
}
