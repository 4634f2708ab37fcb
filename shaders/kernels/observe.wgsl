// The report of every particle's motion, once all couplings have left their half kicks, and the particle by its number with
// its momentum at the full step.
override PARTICLES: u32;
@group(0) @binding(22) var<storage, read_write> kicks: array<vec4<i32>>;
@group(0) @binding(40) var<storage, read_write> reported: array<array<vec4<u32>, 2>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) { observe(slot); }
    total_reduce(group, lane);
}

fn observe(slot: u32) {
    prepare_position_noise();
    let me = stored_particle(slot);
    let id = me.position.w;
    let species = species_of(me);
    let bath = position_bath(id, species, Vector(drift_steps(me.momentum)) * unit_lengths());
    note_position_bath(species, bath);
    let kick = steps_of(kicks[slot]) + Steps(round(position_impulse(bath))) + closing_of_hold(id);
    kicks[slot] = vec4<i32>(0);
    var momentum = steps_of(me.momentum) + clock_closing() * kick;
    momentum = select(momentum, Steps(0), is_fixed(species));
    begin_force();
    add_force(momentum_word(kick, 0));
    store_force(id);
    let p = Vector(momentum);
    total_add(0u, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    let word = momentum_word(momentum, species);
    total_add(2u, sum64_of_i32(word.x));
    total_add(3u, sum64_of_i32(word.y));
    if (DIMENSION == 3u) { total_add(4u, sum64_of_i32(word.z)); }
    reported[id] = array<vec4<u32>, 2>(me.position, bitcast<vec4<u32>>(word));
}
