// The report of every cell: sums of its motion, mass, volume and what its equation of state gives.
override VOLUME_STEPS: f32;    // and in a volume

@compute @workgroup_size(WORKGROUP)
fn observe_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { observe_cell(slot); }
    if (slot == 0u) { observe_run(); }
    total_reduce(group, lane);
}

fn observe_cell(slot: u32) {
    let me = stored_particle(slot);
    let velocity = velocity_of(me);
    let volume = volumes[slot];
    total_add(0u, sum64_of_f32(0.5 * mass_of(me) * dot(velocity, velocity) * KINETIC));
    total_add(1u, sum64_of_i32(me.momentum.x));
    total_add(2u, sum64_of_i32(me.momentum.y));
    total_add(3u, Sum64(me.position.z, 0u));
    total_add(4u, sum64_of_f32(volume * VOLUME_STEPS));
    total_add(5u, Sum64(face_counts[slot], 0u));
    observe_gas(me, volume);
    note_report(me);
}

// A gas at the temperature of the scene that exchanges mass has no potential.
fn observe_gas(cell: Particle, volume: f32) {}

// Steps that solve for nothing and limit nothing have nothing more to report.
fn observe_run() {}

// No analysis asks for cells by their numbers.
fn note_report(cell: Particle) {}
