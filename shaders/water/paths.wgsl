// Paths of particles of shallow water across the periodic box: see space/paths.

// Follows particles in one array. One invocation a place; updates `paths` by id.
@compute @workgroup_size(WORKGROUP)
fn follow_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (!holds_water(index)) { return; }
    let particle = load_water(index);
    follow(particle.id, vec4<u32>(particle.position, 0u, 0u));
}

// Follows particles in bins, those of a cell one after the other. One invocation a cell; updates `paths` by id.
@compute @workgroup_size(WORKGROUP)
fn follow_bins(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cell = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (cell >= CELLS_X * CELLS_Y) { return; }
    let bin = opened_bin(cell);
    for (var k = 0u; k < bin.count; k++) {
        let particle = load_water(place_in(bin, k));
        follow(particle.id, vec4<u32>(particle.position, 0u, 0u));
    }
}
