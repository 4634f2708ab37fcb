// After an upload: where the particles are, and whether their neighbours have to be listed.
override PARTICLES: u32;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let position = stored_position(slot);
    note_slot(position.w, slot);
    check_anchor(slot, fraction_of(position));
}
