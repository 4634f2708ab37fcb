// Hands out the rounded masses of a cell for splines of order 3, and what is left of the total to one node: eight cells of a row
// add up what they bring to the same nodes, so that each has one column of four to store, and three more are left over.
@group(0) @binding(18) var<storage, read_write> contributions: array<Four>; // [cell], then [eight of cells][column beside it]

// What another lane brings to this lane's column.
fn from_lane(share: IntegerPowers, lane: u32, inside: bool) -> IntegerPowers {
    return select(IntegerPowers(0), subgroupShuffle(share, lane & 7u), inside);
}
fn spread(cell: u32, weights: Square, total: i32, too_much: bool) {
    let lane = lane_of_eight;
    let share0 = IntegerPowers(round(weights[0]));
    var share1 = IntegerPowers(round(weights[1]));
    let share2 = IntegerPowers(round(weights[2]));
    let share3 = IntegerPowers(round(weights[3]));
    let given = share0 + share1 + share2 + share3;
    share1.y += total - (given.x + given.y + given.z + given.w);
    var column = share1 + from_lane(share0, lane + 1u, lane < 7u) + from_lane(share2, lane - 1u, lane > 0u)
        + from_lane(share3, lane - 2u, lane > 1u);
    column.y = select(column.y, TOO_MUCH, too_much);
    contributions[cell] = four(bitcast<vec4<u32>>(column));
    let before = subgroupShuffle(share0, 0u);
    let after = subgroupShuffle(share3, 6u) + subgroupShuffle(share2, 7u);
    let beyond = subgroupShuffle(share3, 7u);
    if (lane < 3u) {
        let beside = select(select(beyond, after, lane == 1u), before, lane == 0u);
        contributions[CELLS_X * CELLS_Y + 3u * (cell / 8u) + lane] = four(bitcast<vec4<u32>>(beside));
    }
}
