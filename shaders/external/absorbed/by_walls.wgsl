// Walls absorb the impulses on the particles that are frozen behind them, see external/layers.
fn absorb(me: Particle, impulse: Steps) {
    is_booked = is_own(me.position);
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis < DIMENSION && any(impulse != Steps(0))) { note_reflection(axis, is_behind_upper(place, axis), impulse); }
}

// The place of the sums of the walls that have layers in a report: three components for the lower wall, then for the
// upper one.
override FROZEN_SUMS: u32;
var<private> absorbed: array<vec2<u32>, 6>; // of each invocation

// The momentum that a frozen particle would have gained at the report point counts as absorbed by its wall.
fn report_absorbed(me: Particle, impulse: Steps) {
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis == DIMENSION) { return; }
    let gained = momentum_word(impulse, 0);
    let first = select(0u, 3u, is_behind_upper(place, axis));
    for (var k = 0u; k < 3u; k++) { absorbed[first + k] = sum64_add(absorbed[first + k], sum64_of_i32(gained[k])); }
}
fn reduce_absorbed(group: u32, lane: u32) {
    for (var k = 0u; k < 6u; k++) { reduce_quantity(FIRST_GROUP + group, lane, FROZEN_SUMS + k, absorbed[k]); }
}
