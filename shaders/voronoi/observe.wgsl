// The report of Voronoi cells: sums of motion, mass, volume and what the equation of state gives.
override VOLUME_STEPS: f32;    // quanta of the sum in a volume

fn observe_cell(slot: u32) {
    let me = stored_particle(slot);
    let velocity = velocity_of(me);
    let volume = volumes[slot];
    total_add(SUM_KINETIC_ENERGY, sum64_of_f32(0.5 * mass_of(me) * dot(velocity, velocity) * KINETIC));
    total_add(SUM_MOMENTUM, sum64_of_i32(me.momentum.x));
    total_add(SUM_MOMENTUM + 1u, sum64_of_i32(me.momentum.y));
    total_add(SUM_MASS, Sum64(me.position.z, 0u));
    total_add(SUM_VOLUME, sum64_of_f32(volume * VOLUME_STEPS));
    total_add(SUM_FACE_SIDES, Sum64(face_counts[slot], 0u));
    observe_gas(me, volume);
    note_report(me);
}

// Slot voronoi/gas_report: what the equation of state gives. The plan chooses `isothermal` or `energy`.
// Default: off, a gas at the temperature of the scene that exchanges mass has no potential.
fn observe_gas(cell: Particle, volume: f32) {}

// Slot voronoi/run_report: what the run counts. The plan chooses `limits` if there are any, `solver` if friction is solved for.
// Default: off, neither.
fn observe_run() {}

// Slot voronoi/note: keeps a cell by id. Default: off, no analysis needs cells by id. The plan chooses `by_id`.
fn note_report(cell: Particle) {}

// Sums what is observed of the cells. One invocation a cell; reads particles, `volumes` and `face_counts`, writes `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn observe_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { observe_cell(slot); }
    if (slot == 0u) { observe_run(); }
    total_reduce(group, lane);
}
