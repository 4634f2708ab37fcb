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
        let face = number * PARTICLES + slot;
        let word = face_words[face];
        let other = neighbour_of(word);
        if (other == slot) { continue; }
        let they = stored_particle(other);
        let theirs = side_of(other, they);
        let facet = facet_of(face, word, me.position, they.position);
        let twist = limited_twist(facet, twist_of(face, facet), mine, theirs);
        let mass = transferred_mass(facet, twist, mine, theirs);
        let impulse = pressing(facet, twist, mine, theirs) + 0.5 * mass * (mine.velocity + theirs.velocity)
            + rubbing_impulse(facet, mine, theirs);
        impulses += impulse;
        masses += mass;
        heat += carried_energy(facet, twist, mass, mine, theirs)
            - 0.5 * dot(impulse, mine.velocity - theirs.velocity) + 0.5 * mass * dot(mine.velocity, mine.velocity);
    }
    let after = (mine.mass * mine.velocity + impulses) / (mine.mass + masses);
    let volume = volumes[slot];
    predictions[slot] =
        vec4<f32>(0.5 * (mine.velocity + after), middle_pressure(me, mine.pressure, volume, heat), volume);
}
