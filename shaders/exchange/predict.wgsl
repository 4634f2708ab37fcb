// A prediction of an exchange: the mean velocity of before and after it, at which impulses do their work, and the
// pressure in the middle of it. Neither has to be exact for anything to be conserved.

// Slot exchange/middle: the pressure that an exchange of heat is expected to have in the middle.
// Default: that of the internal energy halfway. The plan chooses `start` for explicit steps.
fn middle_pressure(cell: Particle, pressure: f32, volume: f32, heat: f32) -> f32 {
    return pressure_at(internal_energy_of(cell) + 0.5 * heat, volume);
}

// Predicts the exchange of a cell from the impulses of all its faces: slots as in exchange/exchange. One invocation a cell; reads
// particles and faces, writes `predictions`.
@compute @workgroup_size(WORKGROUP)
fn predict_exchange(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_noise();
    let me = stored_particle(slot);
    let mine = side_of(slot, me);
    var impulses = Vector(0.0);
    var masses = 0.0;
    var heat = 0.0;
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = face_of(slot, number);
        if (face.other == slot) { continue; }
        let they = stored_particle(face.other);
        let theirs = side_of(face.other, they);
        let facet = facet_of(face, me.position, they.position);
        let crossing = crossing_of(face, facet, mine, theirs);
        impulses += crossing.impulse;
        masses += crossing.mass;
        heat += carried_energy(facet, crossing.twist, crossing.mass, mine, theirs)
            - 0.5 * dot(crossing.impulse, mine.velocity - theirs.velocity)
            + 0.5 * crossing.mass * dot(mine.velocity, mine.velocity);
    }
    let after = (mine.mass * mine.velocity + impulses) / (mine.mass + masses);
    let volume = volumes[slot];
    predictions[slot] =
        vec4<f32>(0.5 * (mine.velocity + after), middle_pressure(me, mine.pressure, volume, heat), volume);
}
