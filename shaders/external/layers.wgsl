// Layers of frozen particles behind plane walls, in the gap that nothing else enters: see external/walls. They keep the momentum that goes
// with the motion of their wall and drift with it; the impulses that pairs give them their wall takes up.

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
