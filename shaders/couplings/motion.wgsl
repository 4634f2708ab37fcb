// The motion of particles, once all couplings have added their half kicks: Cotter and Reich (14)-(17),
// doi:10.1209/epl/i2003-00621-8.

// Ends a step: closing and opening half kicks by all couplings, then the drift. One invocation a stored particle; reads and
// clears `kicks`, updates the particle and its baths, adds to `wall_impulses` where there are walls.
@compute @workgroup_size(WORKGROUP)
fn move_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = stored_particle(slot);
    let species = species_of(me);
    let own = advance_own(me);
    let kick = steps_of(kicks[slot]) + own.both;
    kicks[slot] = vec4<i32>(0);
    let opening = kick + own.opening;
    let closing = clock_closing() * (kick + own.closing);
    let momentum = held_momentum(me, steps_of(me.momentum) + closing + opening);
    let travelled = Vector(momentum) * drift_of(species);
    let end = travel(me.position, momentum, species);
    raise(failures_of_particles
        | select(0u, FAILURE_MOMENTUM, any_beyond(momentum, MOMENTUM_LIMIT) || any_beyond(end.momentum, MOMENTUM_LIMIT))
        | select(FAILURE_DISPLACEMENT, 0u, all_within(travelled, DISPLACEMENT_LIMIT)));
    let word = momentum_word(end.momentum, species);
    store_particle(slot, advanced_particle(position_word(end.place, me.position.w), word, held_kick(me, end.turned * opening)));
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
    let me = stored_particle(slot);
    let id = me.position.w;
    let own = observe_own(me);
    let kick = steps_of(kicks[slot]) + own.both + own.closing;
    kicks[slot] = vec4<i32>(0);
    let momentum = steps_of(me.momentum) + clock_closing() * kick;
    begin_force();
    add_reported_force(momentum_word(kick, 0));
    store_force(id);
    let kept = reported_motion(me, momentum);
    observe_own_products(me, kept);
    report_motion(me, momentum, Sum64(0u));
    reported[id] = array<vec4<u32>, 2>(me.position, bitcast<vec4<u32>>(momentum_word(kept, species_of(me))));
}
