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
    let hold = advance_hold(id);
    let bath = position_bath(me, species);
    keep_position_bath(id, bath);
    let impulse = position_impulse(bath);
    let kick = steps_of(kicks[slot]) + Steps(round(impulse));
    kicks[slot] = vec4<i32>(0);
    let opening = kick + held_kick(me, hold.opening);
    let closing = kick + held_kick(me, hold.closing);
    let momentum = held_momentum(me, steps_of(me.momentum) + clock_closing() * closing + opening);
    let travelled = Vector(momentum) * drift_of(species);
    let end = travel(me.position, momentum, species);
    raise(select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT))
        | select(0u, FAILURE_MOMENTUM, any_beyond(momentum, MOMENTUM_LIMIT) || any_beyond(end.momentum, MOMENTUM_LIMIT))
        | select(FAILURE_DISPLACEMENT, 0u, all_within(travelled, DISPLACEMENT_LIMIT)));
    let word = momentum_word(end.momentum, species);
    store_particle(slot, advanced_particle(position_word(end.place, id), word, held_kick(me, end.turned * opening)));
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
    reduce_absorbed(group, lane);
}

// Brings one particle to the report point, and adds what is observed of it.
fn observe_particle(slot: u32) {
    prepare_position_noise();
    let me = stored_particle(slot);
    let id = me.position.w;
    let species = species_of(me);
    let bath = position_bath(me, species);
    note_position_bath(species, bath);
    let kick = steps_of(kicks[slot]) + Steps(round(position_impulse(bath))) + held_kick(me, closing_of_hold(id));
    kicks[slot] = vec4<i32>(0);
    let momentum = steps_of(me.momentum) + clock_closing() * kick;
    begin_force();
    add_reported_force(momentum_word(kick, 0));
    store_force(id);
    let kept = reported_motion(me, momentum);
    note_bath_products(me.position, species, bath, Vector(kept));
    report_motion(me, momentum, Sum64(0u));
    reported[id] = array<vec4<u32>, 2>(me.position, bitcast<vec4<u32>>(momentum_word(kept, species)));
}

// Slot baths/coloured_noise: impulses of a coloured noise over the half steps around this step, in integer momentum units.
// Default: off. The plan chooses `held` if the scene has such a noise.
struct NoiseImpulses { closing: Steps, opening: Steps }
fn advance_hold(id: u32) -> NoiseImpulses { return NoiseImpulses(Steps(0), Steps(0)); }
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
