// Follows the particles, in the order in which they are stored, on their ways round the box.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let position = stored_position(slot);
    follow(position.w, position_word(fraction_of(position), 0u));
}
