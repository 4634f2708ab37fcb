// Frozen particles behind walls, see external/layers: what they are given their wall takes up.

// The momentum that a particle keeps of a new one: all of it, or where it is frozen what it had, and its wall takes up the rest.
fn held_momentum(me: Particle, momentum: Steps) -> Steps {
    is_booked = is_own(me.position);
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis == DIMENSION) { return momentum; }
    let held = steps_of(me.momentum);
    if (any(momentum != held)) { note_reflection(axis, is_behind_upper(place, axis), momentum - held); }
    return held;
}
fn held_kick(me: Particle, kick: Steps) -> Steps { return select(kick, Steps(0), is_behind(fraction_of(me.position))); }

// The place of the sums of the walls that have layers in a report: three components for the lower wall, then for the upper one.
override FROZEN_SUMS: u32;
var<private> taken_up: array<vec2<u32>, 6>; // of each invocation

// What a report sums of the motion of a particle. What is frozen has none of its own, and no part in the virial: half of what a pair adds
// belongs to its other particle. The momentum that it would have gained counts as taken up by its wall.
fn report_motion(me: Particle, momentum: Steps, virial: Sum64) {
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis == DIMENSION) {
        observe_motion(species_of(me), momentum, virial);
        return;
    }
    let gained = momentum_word(momentum - steps_of(me.momentum), 0);
    let first = select(0u, 3u, is_behind_upper(place, axis));
    for (var k = 0u; k < 3u; k++) { taken_up[first + k] = sum64_add(taken_up[first + k], sum64_of_i32(gained[k])); }
}
fn reported_motion(me: Particle, momentum: Steps) -> Steps {
    return select(momentum, steps_of(me.momentum), is_behind(fraction_of(me.position)));
}
// The energies of pairs are those of both ends; forces and curvatures are those of particles that move.
fn report_configuration(me: Particle, sums: PairSums, bonded: Steps) {
    if (is_behind(fraction_of(me.position))) {
        pair_total_add(5u, sums.energy);
        return;
    }
    observe_configuration(sums, bonded);
}
fn reported_virial(me: Particle, virial: Sum64) -> Sum64 {
    return select(virial, Sum64(0u), is_behind(fraction_of(me.position)));
}
fn reduce_taken_up(group: u32, lane: u32) {
    for (var k = 0u; k < 6u; k++) { reduce_quantity(group, lane, FROZEN_SUMS + k, taken_up[k]); }
}
