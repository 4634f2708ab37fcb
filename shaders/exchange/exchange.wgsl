// What crosses the faces of Voronoi cells: the owner of each face computes it once, rounds it to integers, and adds it to both
// cells with opposite signs. So momentum, mass and energy are constant to the last bit.
override IMPULSE_STEPS: f32; // integer units in a unit of momentum
override MASS_STEPS: f32;    // integer units in a unit of mass
override ENERGY_STEPS: f32;  // integer units in a unit of energy

const EXCHANGED_UNITS_LIMIT: f32 = 536870912.0; // 2^29, a quarter of the range of what they are added up in

// What a cell brings to an exchange through its faces.
struct Side {
    id: u32,
    mass: f32,
    velocity: Vector,    // when the exchange begins
    mean: Vector,        // of before and after it
    pressure: f32,
    density: f32,        // of mass
    energy_density: f32, // of internal energy
    temperature: f32,
}

// The functions below give what comes into `mine` through a face in the step, and change sign under exchange of the two cells
// but for rounding, which does not matter: one cell computes for both. Their plans are in src/families/voronoi/plan/exchange.rs
// and mod.rs.

// Slots exchange/twist and exchange/form: how pressures act. `twist` is the way from the middle between the cells to that of the
// face, over their distance: even under exchange. Default: off, no pressure acts in this part of the step. Variants of
// exchange/form: gradient (constant mass), exchange (mass crosses the faces). The plan follows the form of the scene.
fn twist_of(face: Face, facet: Facet) -> Vector { return Vector(0.0); }
fn transferred_mass(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 { return 0.0; }
fn pressing(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }
fn carried_energy(facet: Facet, twist: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }

// Slot exchange/sweep: the twist that limits let pass, by means of slot exchange/turn_bound. Default: off, faces turn as they do.
// For the form gradient the plan chooses `limited` if cells keep energy, `bounded` if they have a temperature.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return twist; }

// Slot exchange/swept_energy: the part of the mass whose internal energy the limit lets pass, even under exchange.
// Default: off, mass carries no energy that is kept. The plan chooses `limited` if cells keep energy and exchange mass.
fn part_within_energy(wanted: f32, mine: Side, theirs: Side) -> f32 { return 1.0; }

// Slot exchange/rubbing: the impulse of friction, odd under exchange. Default: off, no friction acts in this part of the step.
// The plan chooses `viscous`.
fn rubbing_impulse(facet: Facet, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }

// Slot exchange/random_impulse: its random part, odd under exchange. Default: off, friction without a temperature has no noise.
// The plan chooses `thermal`.
fn random_face_impulse(facet: Facet, mine: u32, theirs: u32, temperature: f32) -> Vector { return Vector(0.0); }

// Slot exchange/conduction: heat, conducted and random, odd under exchange. Default: off, no heat is conducted in this part of
// the step. The plan chooses `heat`.
fn conducted_heat(facet: Facet, mine: Side, theirs: Side) -> f32 { return 0.0; }

// Slot exchange/energy: energy of impulse, mass and heat. Default: off, cells keep no energy. The plan chooses `kept` if they do.
fn energy_through(facet: Facet, twist: Vector, impulse: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }

// Slot exchange/limit: `limited` gives how much of what is wanted may cross a face, odd under exchange, and `report_cuts` counts
// how often that was less. Default: off, nothing that crosses a face can run out. The plan chooses `counted`.
fn report_cuts() {}

// The mass and the impulse that cross a face, into `mine`: the same for an exchange and for its prediction.
struct Crossing { twist: Vector, mass: f32, impulse: Vector }
fn crossing_of(face: Face, facet: Facet, mine: Side, theirs: Side) -> Crossing {
    let twist = limited_twist(facet, twist_of(face, facet), mine, theirs);
    let mass = transferred_mass(facet, twist, mine, theirs);
    let impulse = pressing(facet, twist, mine, theirs) + 0.5 * mass * (mine.velocity + theirs.velocity)
        + rubbing_impulse(facet, mine, theirs);
    return Crossing(twist, mass, impulse);
}

// Computes what crosses the faces that a cell owns (voronoi/visit/exchange). One invocation a cell; reads particles and faces,
// adds integer units to both cells of a face in `exchanges`.
@compute @workgroup_size(WORKGROUP)
fn exchange_through_faces(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_noise();
    let me = stored_particle(slot);
    var visit = Visit(me, side_of(slot, me), vec4<i32>(0), true);
    visit_faces(slot, &visit);
    move_units(slot, visit.units);
    raise(select(FAILURE_IMPULSE, 0u, visit.fits));
    report_cuts();
}
