// Takes the particles as they were copied in the order of cells.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (number >= PARTICLES) { return; }
    copy_particle(number, number);
    set_order(number, number);
}
