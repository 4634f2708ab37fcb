// The end of a step for every particle: closing and opening half kicks by all couplings, then the drift, Cotter and Reich
// (14)-(17), doi:10.1209/epl/i2003-00621-8.
override PARTICLES: u32;
override DISPLACEMENT_LIMIT: f32;
@group(0) @binding(22) var<storage, read_write> kicks: array<vec4<i32>>;

const MOMENTUM_LIMIT: i32 = 1073741824; // 2^30

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    prepare_position_noise();
    let me = stored_particle(slot);
    let id = me.position.w;
    let species = species_of(me);
    let held = advance_hold(id);
    let bath = position_bath(id, species, Vector(drift_steps(me.momentum)) * unit_lengths());
    keep_position_bath(id, bath);
    let impulse = position_impulse(bath);
    let kick = steps_of(kicks[slot]) + Steps(round(impulse));
    kicks[slot] = vec4<i32>(0);
    let opening = select(kick + held.opening, Steps(0), is_fixed(species));
    var momentum = steps_of(me.momentum) + clock_closing() * (kick + held.closing) + opening;
    momentum = select(momentum, Steps(0), is_fixed(species));
    let travelled = Vector(momentum) * drift_of(species);
    raise(select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT))
        | select(0u, FAILURE_MOMENTUM, any_beyond(momentum, MOMENTUM_LIMIT))
        | select(FAILURE_DISPLACEMENT, 0u, all_within(travelled, DISPLACEMENT_LIMIT)));
    let word = momentum_word(momentum, species);
    let fraction = fraction_of(me.position) + unsigned(drift_steps(word));
    store_particle(slot, advanced_particle(position_word(fraction, id), word, opening));
    check_anchor(slot, fraction);
}
