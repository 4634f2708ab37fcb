// The mass of four nodes above each other, from what strips of cells bring to them: the strip they lie in, those below and above,
// and the ones to the left and right of these.

// [strip][column][which rows], then [strip][eight][column outside it][which rows].
var<storage, read_write> contributions: array<Four>;
var<private> gathered_shares: vec4<i32>;
var<private> least_mass: vec4<i32>;

fn gather(share: vec4<i32>) {
    gathered_shares += share;
    least_mass = min(least_mass, min(share, gathered_shares));
}
// What the strips of one column bring: a strip reaches two nodes above it and one below.
fn gather_column(first: u32, width: u32, strip: u32) {
    let strips = CELLS_Y / STRIP;
    let below = first + 2u * width * select(strip - 1u, strips - 1u, strip == 0u);
    let above = first + 2u * width * select(strip + 1u, 0u, strip + 1u == strips);
    gather(bitcast<vec4<i32>>(four_words(contributions[first + 2u * width * strip])));
    gather(vec4<i32>(bitcast<vec2<i32>>(first_words(contributions[below + 1u])), 0, 0));
    gather(vec4<i32>(0, 0, 0, bitcast<i32>(last_words(contributions[above + 1u]).x)));
}

// Sums the masses of the nodes of a column of a strip. One invocation a column of a strip; reads `contributions`, writes
// `node_masses`.
@compute @workgroup_size(WORKGROUP)
fn gather_nodes_of_eight(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let column = index % CELLS_X;
    let strip = index / CELLS_X;
    if (strip * STRIP >= CELLS_Y) { return; }
    gather_column(2u * column, CELLS_X, strip);
    // The last column of an eight is reached by the eight after it, the first two by the one before.
    let eights = CELLS_X / 8u;
    let place = (column + 1u) % 8u;
    if (place < 3u) {
        let eight = (column / 8u + select(eights - 1u, 1u, place == 0u)) % eights;
        gather_column(2u * (CELLS_X * CELLS_Y / STRIP + 3u * eight + place), 3u * eights, strip);
    }
    var crowded = 0xffffffffu; // the first node with too much
    for (var k = STRIP; k > 0u; k--) {
        let node = (strip * STRIP + k - 1u) * CELLS_X + column;
        // A cell has too much, or the sum has wrapped round.
        crowded = select(crowded, node, least_mass[k - 1u] < LEAST_MASS);
        node_masses[node] = kept_mass(gathered_shares[k - 1u], least_mass[k - 1u]);
    }
    raise_at(select(FAILURE_CROWDING, 0u, crowded == 0xffffffffu), crowded);
}

// == mesh/nodes/cubic_of_eight
// The surface under splines of order 3, for the cells of a strip: each lane loads one column of nodes, row after row, and
// three lanes those outside the eight.
var<private> own_nodes: vec4<f32>;    // on nodes above each other
var<private> beside_nodes: vec4<f32>; // the column before the eight, and the two after it
var<private> beside_column: u32;

fn load_row(column: u32, row: u32) {
    own_nodes = vec4<f32>(own_nodes.yzw, surface_at(CELLS_X * row + column));
    if (lane_of_eight < 3u) { beside_nodes = vec4<f32>(beside_nodes.yzw, surface_at(CELLS_X * row + beside_column)); }
}
fn begin_strip(column: u32, row: u32) {
    let lane = lane_of_eight;
    beside_column = (column - lane + select(7u + lane, CELLS_X - 1u, lane == 0u)) % CELLS_X;
    load_row(column, node_along(row, 0u, CELLS_Y));
    load_row(column, node_along(row, 1u, CELLS_Y));
    load_row(column, node_along(row, 2u, CELLS_Y));
}
// The surface on the nodes of a cell, [along x][along y], row after row of a strip.
fn nodes_of(column: u32, row: u32) -> Square {
    let lane = lane_of_eight;
    load_row(column, node_along(row, 3u, CELLS_Y));
    let before = select(subgroupShuffle(own_nodes, (lane + 7u) & 7u), beside_nodes, lane == 0u);
    let after = select(subgroupShuffle(own_nodes, (lane + 1u) & 7u), subgroupShuffle(beside_nodes, 1u), lane == 7u);
    let beyond = select(subgroupShuffle(own_nodes, (lane + 2u) & 7u), subgroupShuffle(beside_nodes, (lane + 3u) & 3u), lane > 5u);
    return Square(before, own_nodes, after, beyond);
}

// == mesh/spread/cubic_of_eight
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

// The share of another lane in this lane's column.
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

// == mesh/pass/push_of_eight
// Moves the particles of eight cells by one step, eight at a time regardless of their cells, from before the closing kick or,
// after a report, from the report point.
override LEAST_DEPTH: f32; // as a deviation from the mean
var<private> dry_cell: u32 = NO_CELL; // the first whose depth is not positive

fn of_lane(polynomial: Square, lane: u32) -> Square {
    return Square(subgroupShuffle(polynomial[0], lane), subgroupShuffle(polynomial[1], lane),
        subgroupShuffle(polynomial[2], lane), subgroupShuffle(polynomial[3], lane));
}

fn visit_cell(cell: u32) {
    let nodes = nodes_of(cell % CELLS_X, cell / CELLS_X);
    // A negative depth, beyond what rounding makes of zero, has no waves, only instability; nor has NaN.
    let depth = depth_in_cell(cell, nodes);
    dry_cell = select(min(dry_cell, cell), dry_cell, is_number(depth) && depth > LEAST_DEPTH);
    let polynomial = surface_of(nodes);
    let closes = CLOSES == 1u && clock_closing() == 1;
    let bin = opened_bin(cell);
    let eight = opened_eight(bin);
    var first = 0u;
    // Ends: first counts to eight.count. Left at its end: see pairs/clusters.
    loop {
        if (first < eight.count) {
            let index = place_in_eight(eight, bin, min(first + lane_of_eight, eight.count - 1u));
            var particle = load_water(index);
            let x = place_along(particle.position.x, CELLS_X);
            let y = place_along(particle.position.y, CELLS_Y).offset;
            let owner = x.cell & 7u;
            let kick = half_kick(of_lane(polynomial, owner), x.offset, y);
            if (closes) { particle.velocity = closed(particle.velocity, kick); }
            store_moved_of_eight(eight, bin, cell, owner, first, index, opened(particle, kick));
        }
        first += 8u;
        if (first >= eight.count) { break; }
    }
    end_moving_eight(eight, bin, cell);
}
// Once a strip: software adapters pay for every place in the program that raises, even if nothing fails.
fn end_strip(column: u32, row: u32) {
    raise_at(failures_of_motion | select(FAILURE_DEPTH, 0u, dry_cell == NO_CELL), dry_cell);
}

// == water/eight/bins
// The particles of eight cells side by side, each with a bin, are numbered through, cell after cell. Those that stay are counted
// across the lanes, so that each finds its place in its bin.
struct Eight {
    ends: array<u32, 8>, // the first number that is not in this cell nor in one before
    begin: u32,          // of this lane's cell
    end: u32,
    count: u32,          // of all eight
}
var<private> stayed_so_far: u32;   // of all eight cells
var<private> stayed_at_begin: u32; // when this lane's cell began, and when it ended
var<private> stayed_at_end: u32;

fn opened_eight(bin: Bin) -> Eight {
    var eight: Eight;
    var end = 0u;
    for (var lane = 0u; lane < 8u; lane++) {
        end += subgroupShuffle(bin.count, lane);
        eight.ends[lane] = end;
        eight.end = select(eight.end, end, lane == lane_of_eight);
    }
    eight.begin = eight.end - bin.count;
    eight.count = end;
    stayed_so_far = 0u;
    stayed_at_begin = 0u;
    stayed_at_end = 0u;
    return eight;
}
fn place_in_eight(eight: Eight, bin: Bin, number: u32) -> u32 {
    let owner = select(0u, 1u, number >= eight.ends[0]) + select(0u, 1u, number >= eight.ends[1])
        + select(0u, 1u, number >= eight.ends[2]) + select(0u, 1u, number >= eight.ends[3])
        + select(0u, 1u, number >= eight.ends[4]) + select(0u, 1u, number >= eight.ends[5])
        + select(0u, 1u, number >= eight.ends[6]);
    let owned = Bin(subgroupShuffle(bin.begin, owner), subgroupShuffle(bin.stayed, owner), 0u, bin.turn);
    return place_in(owned, number - subgroupShuffle(eight.begin, owner));
}
// The sum over the lanes up to this one.
fn sum_of_earlier_lanes(value: u32) -> u32 {
    let lane = lane_of_eight;
    var sum = value;
    sum += select(0u, subgroupShuffle(sum, (lane - 1u) & 7u), lane >= 1u);
    sum += select(0u, subgroupShuffle(sum, (lane - 2u) & 7u), lane >= 2u);
    sum += select(0u, subgroupShuffle(sum, (lane - 4u) & 7u), lane >= 4u);
    return sum;
}
fn store_moved_of_eight(eight: Eight, bin: Bin, cell: u32, owner: u32, first: u32, index: u32, particle: Water) {
    let lane = lane_of_eight;
    let destination = cell_of(particle.position);
    let inside = first + lane < eight.count;
    let stays = inside && destination == cell - lane + owner;
    let stayed_here = sum_of_earlier_lanes(select(0u, 1u, stays));
    let stayed_before = stayed_so_far + stayed_here - select(0u, 1u, stays);
    let begin = eight.begin - first;
    let end = eight.end - first;
    stayed_at_begin = select(stayed_at_begin, subgroupShuffle(stayed_before, begin & 7u), begin < 8u);
    stayed_at_end = select(stayed_at_end, subgroupShuffle(stayed_before, end & 7u), end < 8u);
    stayed_so_far += subgroupShuffle(stayed_here, 7u);
    var place = subgroupShuffle(bin.begin - stayed_at_begin, owner) + stayed_before;
    if (inside && !stays) {
        let turn = 1u - bin.turn;
        let arrival = atomicAdd(&arrived[turn * CELLS_X * CELLS_Y + destination], 1u);
        place = destination * (CAPACITY + 2u * ARRIVALS) + CAPACITY + turn * ARRIVALS + arrival;
        failures_of_motion |= select(FAILURE_FRAMES, 0u, arrival < ARRIVALS);
        place = select(index, place, arrival < ARRIVALS);
    }
    if (inside) { store_water(place, particle); }
}
fn end_moving_eight(eight: Eight, bin: Bin, cell: u32) {
    // Cells that begin or end with the end of the eight may have no number there.
    let at_begin = select(stayed_at_begin, stayed_so_far, eight.begin == eight.count);
    kept_in_bin = select(stayed_at_end, stayed_so_far, eight.end == eight.count) - at_begin;
    failures_of_motion |= select(0u, FAILURE_FRAMES, kept_in_bin > CAPACITY);
    end_moving(cell, bin);
}

// == water/eight/sorted
// The particles of eight cells side by side, in the order of their cells, are one stretch.
struct Eight { begin: u32, count: u32 }

fn opened_eight(bin: Bin) -> Eight {
    let begin = subgroupShuffle(bin.begin, 0u);
    return Eight(begin, subgroupShuffle(bin.begin + bin.count, 7u) - begin);
}
fn place_in_eight(eight: Eight, bin: Bin, number: u32) -> u32 { return index_in_order(eight.begin + number); }
fn store_moved_of_eight(eight: Eight, bin: Bin, cell: u32, owner: u32, first: u32, index: u32, particle: Water) {
    if (first + lane_of_eight < eight.count) { store_moved(cell - lane_of_eight + owner, bin, index, particle); }
}
fn end_moving_eight(eight: Eight, bin: Bin, cell: u32) {}

// == core/reduction/of_eight
// Sums by shuffles over the eight lanes of a workgroup that is one subgroup.
fn reduce_quantity(group: u32, lane: u32, quantity: u32, value: Sum64) {
    var sum = value;
    for (var distance = 4u; distance > 0u; distance >>= 1u) {
        sum = sum64_add(sum, subgroupShuffle(sum, lane ^ distance));
    }
    if (lane == 0u) { partial_sums[group * QUANTITIES + quantity] = sum; }
}
