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
    // What begins or ends with the end of the eight may have no number there.
    let at_begin = select(stayed_at_begin, stayed_so_far, eight.begin == eight.count);
    kept_in_bin = select(stayed_at_end, stayed_so_far, eight.end == eight.count) - at_begin;
    failures_of_motion |= select(0u, FAILURE_FRAMES, kept_in_bin > CAPACITY);
    end_moving(cell, bin);
}
