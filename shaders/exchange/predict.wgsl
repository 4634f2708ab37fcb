// A prediction of an exchange: the mean velocity of before and after it, at which impulses do their work, and the
// pressure in the middle of it. Neither has to be exact for anything to be conserved.

// Slot exchange/middle: the pressure that an exchange of heat is expected to have in the middle.
// Default: that of the internal energy halfway. The plan chooses `start` for explicit steps.
fn middle_pressure(cell: Particle, pressure: f32, volume: f32, heat: f32) -> f32 {
    return pressure_at(internal_energy_of(cell) + 0.5 * heat, volume);
}

// Predicts the exchange of a cell from the impulses of all its faces (voronoi/visit/prediction): slots as in exchange/exchange. One
// invocation a cell; reads particles and faces, writes `predictions`.
@compute @workgroup_size(WORKGROUP)
fn predict_exchange(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_noise();
    let me = stored_particle(slot);
    let mine = side_of(slot, me);
    var visit = Visit(me, mine, Vector(0.0), 0.0, 0.0);
    visit_faces(slot, &visit);
    let after = (mine.mass * mine.velocity + visit.impulse) / (mine.mass + visit.mass);
    let volume = volumes[slot];
    predictions[slot] =
        vec4<f32>(0.5 * (mine.velocity + after), middle_pressure(me, mine.pressure, volume, visit.heat), volume);
}
