// The motion of particles, once all couplings have added their half kicks: Cotter and Reich (14)-(17),
// doi:10.1209/epl/i2003-00621-8.

// Ends a step: closing and opening half kicks by all couplings, then the drift. One invocation a stored particle; reads and
// clears `kicks`, updates the particle and its baths, adds to `wall_impulses` where there are walls.
@compute @workgroup_size(WORKGROUP)
fn move_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_position_noise();
    let me = stored_particle(slot);
    let id = me.position.w;
    let species = species_of(me);
    let held = advance_hold(id);
    let bath = position_bath(me, species);
    keep_position_bath(id, bath);
    let impulse = position_impulse(bath);
    let kick = steps_of(kicks[slot]) + Steps(round(impulse));
    kicks[slot] = vec4<i32>(0);
    let opening = select(kick + held.opening, Steps(0), is_fixed(species));
    var momentum = steps_of(me.momentum) + clock_closing() * (kick + held.closing) + opening;
    momentum = select(momentum, Steps(0), is_fixed(species));
    let travelled = Vector(momentum) * drift_of(species);
    let end = travel(me.position, momentum, species);
    raise(select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT))
        | select(0u, FAILURE_MOMENTUM, any_beyond(momentum, MOMENTUM_LIMIT) || any_beyond(end.momentum, MOMENTUM_LIMIT))
        | select(FAILURE_DISPLACEMENT, 0u, all_within(travelled, DISPLACEMENT_LIMIT)));
    let word = momentum_word(end.momentum, species);
    store_particle(slot, advanced_particle(position_word(end.place, id), word, end.turned * opening));
    check_anchor(slot, end.place);
}

// The particles of a report, by id, with momenta at the full step: each as two vectors of words.
var<storage, read_write> reported: array<array<vec4<u32>, 2>>;

// Sums the motion of a report. One invocation a stored particle; reads and clears `kicks`, writes `reported` and `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn observe_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { observe_particle(slot); }
    total_reduce(group, lane);
}

// Brings one particle to the report point, and adds what is observed of it.
fn observe_particle(slot: u32) {
    prepare_position_noise();
    let me = stored_particle(slot);
    let id = me.position.w;
    let species = species_of(me);
    let bath = position_bath(me, species);
    note_position_bath(species, bath);
    let kick = steps_of(kicks[slot]) + Steps(round(position_impulse(bath))) + closing_of_hold(id);
    kicks[slot] = vec4<i32>(0);
    var momentum = steps_of(me.momentum) + clock_closing() * kick;
    momentum = select(momentum, Steps(0), is_fixed(species));
    begin_force();
    add_reported_force(momentum_word(kick, 0));
    store_force(id);
    let p = Vector(momentum);
    note_bath_products(me.position, species, bath, p);
    total_add(0u, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    let word = momentum_word(momentum, species);
    total_add(2u, sum64_of_i32(word.x));
    total_add(3u, sum64_of_i32(word.y));
    if (DIMENSION == 3u) { total_add(4u, sum64_of_i32(word.z)); }
    reported[id] = array<vec4<u32>, 2>(me.position, bitcast<vec4<u32>>(word));
}

// Slot couplings/fixed: whether a species is held where it is.
// Default: off, every particle can move. The plan chooses `held` if any species is fixed.
fn is_fixed(species: i32) -> bool { return false; }

// Slot baths/coloured_noise: impulses of a coloured noise over the half steps around this step, in integer momentum units.
// Default: off. The plan chooses `held` if the scene has such a noise.
struct Held { closing: Steps, opening: Steps }
fn advance_hold(id: u32) -> Held { return Held(Steps(0), Steps(0)); }
fn closing_of_hold(id: u32) -> Steps { return Steps(0); }

// Slot baths/positions: a bath on every coordinate, from what the last step has made of it; `position_impulse` is its impulse
// of half a step, `keep_position_bath` stores it. Default: off. The plan chooses `memory` or `white`.
fn position_bath(me: Particle, species: i32) -> Vector { return Vector(0.0); }
fn position_impulse(bath: Vector) -> Vector { return bath; }
fn keep_position_bath(id: u32, bath: Vector) {}

// Slot baths/position_noise: noise of the position bath of a coordinate, in its unit.
// Default: off, the position baths of this scene have no temperature. The plan chooses `gaussian` if they have.
fn prepare_position_noise() {}
fn position_noise(id: u32, species: i32, axis: u32) -> f32 { return 0.0; }

// Slot baths/position_report: adds the energy of a position bath to a report.
// Default: off, such baths have none. The plan chooses `observed` if they have memory.
fn note_position_bath(species: i32, bath: Vector) {}

// Slot baths/position_products: adds the products of a position bath, a momentum and a displacement to a report.
// Default: off, nothing says what their means should be. The plan chooses `tethered` if such baths have memory and tethers say where
// displacements begin.
fn note_bath_products(position: vec4<u32>, species: i32, bath: Vector, momentum: Vector) {}
