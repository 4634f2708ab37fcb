// What crosses the faces: the owner of each computes it once, rounds it to integers, and hands it to both cells with
// opposite signs. So momentum, mass and energy are constant to the last bit.
override IMPULSE_STEPS: f32; // units of momentum in one
override MASS_STEPS: f32;    // units of mass in one
override ENERGY_STEPS: f32;  // units of energy in one

const EXCHANGED_UNITS_LIMIT: f32 = 536870912.0; // 2^29, a quarter of the range of what they are added up in

@compute @workgroup_size(WORKGROUP)
fn exchange_through_faces(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_noise();
    let me = stored_particle(slot);
    let mine = side_of(slot, me);
    var total = vec4<i32>(0);
    var fits = true;
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = number * PARTICLES + slot;
        let word = face_words[face];
        let other = neighbour_of(word);
        let they = stored_particle(other);
        if (!owns_face(me.position.w, they.position.w)) { continue; }
        let theirs = side_of(other, they);
        let facet = facet_of(face, word, me.position, they.position);
        let twist = limited_twist(facet, twist_of(face, facet), mine, theirs);
        let mass = transferred_mass(facet, twist, mine, theirs);
        let impulse = pressing(facet, twist, mine, theirs) + 0.5 * mass * (mine.velocity + theirs.velocity)
            + rubbing_impulse(facet, mine, theirs);
        let energy = energy_through(facet, twist, impulse, mass, mine, theirs);
        let exact = vec4<f32>(impulse * IMPULSE_STEPS, mass * MASS_STEPS, energy * ENERGY_STEPS);
        fits = fits && all_within(exact.xy, EXCHANGED_UNITS_LIMIT) && all_within(exact.zw, EXCHANGED_UNITS_LIMIT);
        let units = vec4<i32>(round(exact));
        total += units;
        move_units(other, -units);
    }
    move_units(slot, total);
    raise(select(FAILURE_IMPULSE, 0u, fits));
    report_cuts();
}

// No heat is conducted in this part of the step.
fn conducted_heat(facet: Facet, mine: Side, theirs: Side) -> f32 { return 0.0; }

// Nobody keeps account of energies.
fn energy_through(facet: Facet, twist: Vector, impulse: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }

// No pressure acts in this part of the step.
fn twist_of(face: u32, facet: Facet) -> Vector { return Vector(0.0); }
fn transferred_mass(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 { return 0.0; }
fn pressing(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }
fn carried_energy(facet: Facet, twist: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }

// Faces turn as they do.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return twist; }

// No friction acts in this part of the step.
fn rubbing_impulse(facet: Facet, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }

// Nothing that crosses a face can run out.
fn report_cuts() {}

// Mass carries no energy that anybody keeps account of.
fn part_within_energy(wanted: f32, mine: Side, theirs: Side) -> f32 { return 1.0; }

// Without a temperature friction has no noise.
fn random_face_impulse(facet: Facet, mine: u32, theirs: u32, temperature: f32) -> Vector { return Vector(0.0); }
