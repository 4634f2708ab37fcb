// Layers of frozen particles behind plane walls, in the gap that nothing else enters: see external/walls. They keep the momentum that goes
// with the motion of their wall and drift with it; their wall absorbs the impulses that pairs give them.

// The axis of the walls behind which a place is; DIMENSION between them.
fn wall_behind(place: Fraction) -> u32 {
    let ends = wall_ends();
    var wall = DIMENSION;
    for (var axis = 0u; axis < DIMENSION; axis++) { wall = select(wall, axis, (ends[axis] > 0u) & (place[axis] >= ends[axis])); }
    return wall;
}
// Whether that is the upper wall: the one that is nearer.
fn is_behind_upper(place: Fraction, axis: u32) -> bool {
    let end = wall_ends()[axis];
    return place[axis] - end < ((0u - end) >> 1u);
}

// Walls absorb the impulses on the particles that are frozen behind them. Particles that are held elsewhere are fixed
// in space.
override FROZEN: u32; // 1 where some are frozen
// The place of the sums of their walls in a report: three components for the lower wall, then for the upper one.
override FROZEN_SUMS: u32 = 0u;
var<private> absorbed: array<vec2<u32>, 6>; // of each invocation

fn absorb(me: Particle, impulse: Steps) {
    if (FROZEN == 0u) { return; }
    is_booked = is_own(me.position);
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis < DIMENSION && any(impulse != Steps(0))) { note_reflection(axis, is_behind_upper(place, axis), impulse); }
}
// The momentum that a frozen particle would have gained at the report point counts as absorbed by its wall.
fn report_absorbed(me: Particle, impulse: Steps) {
    if (FROZEN == 0u) { return; }
    let place = fraction_of(me.position);
    let axis = wall_behind(place);
    if (axis == DIMENSION) { return; }
    let gained = momentum_word(impulse, 0);
    let first = select(0u, 3u, is_behind_upper(place, axis));
    for (var k = 0u; k < 3u; k++) { absorbed[first + k] = sum64_add(absorbed[first + k], sum64_of_i32(gained[k])); }
}
fn reduce_absorbed(group: u32, lane: u32) {
    if (FROZEN == 0u) { return; }
    for (var k = 0u; k < 6u; k++) { reduce_quantity(FIRST_GROUP + group, lane, FROZEN_SUMS + k, absorbed[k]); }
}
