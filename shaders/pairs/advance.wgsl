// The end of a step for one particle: it is checked, drifts (space/travel), and is counted into its next cell.
const STRAIN_LIMIT: f32 = 1073741824.0;
var<private> failures_of_particles: u32; // raised once, when all particles of an invocation are done

// Checks what the integer state can hold. `strain` is the sum of the magnitudes of all impulses on the particle: it shows,
// where the wrapped sum cannot, that the sum has left the range of integers, and it preserves what is not a number.
fn check_particle(momentum: Steps, species: i32, strain: f32) {
    let travelled = Vector(momentum) * drift_of(species);
    failures_of_particles |= select(FAILURE_IMPULSE, 0u, is_within(strain, STRAIN_LIMIT))
        | select(0u, FAILURE_MOMENTUM, any_beyond(momentum, MOMENTUM_LIMIT))
        | select(FAILURE_DISPLACEMENT, 0u, all_within(travelled, DISPLACEMENT_LIMIT));
}

// Stores a particle after its opening kick and drift, and counts it: what friction sees of the kick turns with the momentum. `momentum` and
// `kick` are in integer momentum units.
fn store_advanced(row: u32, index: u32, me: Particle, momentum: Steps, kick: Steps, strain: f32) {
    let species = species_of(me);
    let held = held_momentum(me, momentum);
    check_particle(held, species, strain);
    let end = travel(me.position, held, species);
    failures_of_particles |= select(0u, FAILURE_MOMENTUM, any_beyond(end.momentum, MOMENTUM_LIMIT));
    let slot = unframed_index(row, index);
    let word = momentum_word(end.momentum, species);
    store_particle(slot, advanced_particle(position_word(end.place, me.position.w), word, held_kick(me, end.turned * kick)));
    note_place(slot, end.place);
}

// The second half of a drift that a report has interrupted. One invocation a stored particle; updates it, and
// `wall_impulses` where momenta change; notes its place.
@compute @workgroup_size(WORKGROUP)
fn drift_rest(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= sorted_count()) { return; }
    let me = stored_particle(index);
    let end = travel_rest(me.position, steps_of(me.momentum), species_of(me));
    let momentum = momentum_word(end.momentum, me.momentum.w);
    store_particle(index, Particle(position_word(end.place, me.position.w), momentum));
    note_place(index, end.place);
}
