// Spreads the rounded masses of the cells of a strip for splines of order 3; what is left of a total goes to one node. The cells
// add up what they bring to the same nodes: each column stores seven rows of nodes, four in the strip and three that belong to
// those below and above, and three more columns are stored for the nodes outside the eight.

// [strip][column][which rows], then [strip][eight][column outside it][which rows].
var<storage, read_write> contributions: array<Four>;

// Sums over the rows of a strip so far.
struct Column {
    finished: vec4<i32>, // the last four rows of nodes that no cell will add to
    open: vec4<i32>,     // the rows after them
}
var<private> own_shares: Column;
var<private> beside_shares: Column;

// Adds what a row of cells brings. Where a cell has too much, or a sum wraps round, the node keeps too much.
fn with_row(column: Column, share: IntegerPowers) -> Column {
    let added = column.open + share;
    let least = min(min(column.open, share), added);
    let sum = select(added, vec4<i32>(TOO_MUCH), least < vec4<i32>(LEAST_MASS));
    return Column(vec4<i32>(column.finished.yzw, sum.x), vec4<i32>(sum.yzw, 0));
}
fn store_column(place: u32, column: Column) {
    let inside = vec4<i32>(column.finished.yzw, column.open.x);
    let outside = vec4<i32>(column.open.yz, column.finished.x, 0);
    contributions[2u * place] = stored_four(bitcast<vec4<u32>>(inside));
    contributions[2u * place + 1u] = stored_four(bitcast<vec4<u32>>(outside));
}

// What another lane brings to this lane's column.
fn from_lane(share: IntegerPowers, lane: u32, inside: bool) -> IntegerPowers {
    return select(IntegerPowers(0), subgroupShuffle(share, lane & 7u), inside);
}
fn begin_strip(column: u32, row: u32) {
    own_shares = Column();
    beside_shares = Column();
}
fn spread_masses(cell: u32, weights: Square, total: i32, too_much: bool) {
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
    own_shares = with_row(own_shares, column);
    let before = subgroupShuffle(share0, 0u);
    let after = subgroupShuffle(share3, 6u) + subgroupShuffle(share2, 7u);
    let beyond = subgroupShuffle(share3, 7u);
    beside_shares = with_row(beside_shares, select(select(beyond, after, lane == 1u), before, lane == 0u));
}
fn end_strip(column: u32, row: u32) {
    let lane = lane_of_eight;
    let place = row / STRIP * CELLS_X + column;
    store_column(place, own_shares);
    if (lane < 3u) { store_column(CELLS_X * CELLS_Y / STRIP + 3u * (place / 8u) + lane, beside_shares); }
}
