// Follows particles of shallow water that lie in one array on their ways round the box.
@compute @workgroup_size(WORKGROUP)
fn follow_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let particle = stored(index);
    follow(particle.id, vec4<u32>(particle.position, 0u, 0u));
}

// Follows particles of shallow water that lie in bins, those of a cell one after the other, on their ways round the box.
@compute @workgroup_size(WORKGROUP)
fn follow_bins(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (cell >= CELLS_X * CELLS_Y) { return; }
    let bin = opened_bin(cell);
    for (var k = 0u; k < bin.count; k++) {
        let particle = stored(place_in(bin, k));
        follow(particle.id, vec4<u32>(particle.position, 0u, 0u));
    }
}
