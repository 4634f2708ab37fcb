// Which candidates a cluster of eight particles has in common, for subgroups of eight lanes.
// The candidates of a cluster, nine (three, one) stretches seen as one: the own row first.
struct Stretches {
    own: u32,
    ends: array<i32, 8>, // signed, which the adapter compares in one instruction
    shifts: array<u32, 8>,
    total: u32,
}

fn resolve(s: Stretches, candidate: u32) -> u32 {
    let number = i32(candidate);
    var shift = s.own;
    if (neighbour_rows() > 1u) {
        shift = select(shift, s.shifts[0], number >= s.ends[0]);
        shift = select(shift, s.shifts[1], number >= s.ends[1]);
    }
    if (neighbour_rows() > 3u) {
        shift = select(shift, s.shifts[2], number >= s.ends[2]);
        shift = select(shift, s.shifts[3], number >= s.ends[3]);
        shift = select(shift, s.shifts[4], number >= s.ends[4]);
        shift = select(shift, s.shifts[5], number >= s.ends[5]);
        shift = select(shift, s.shifts[6], number >= s.ends[6]);
        shift = select(shift, s.shifts[7], number >= s.ends[7]);
    }
    return shift + candidate;
}

// Lane k holds the k-th neighbouring row's stretch; every lane learns them all.
fn stretches_of(own: u32, own_length: u32, begin: u32, length: u32) -> Stretches {
    var s: Stretches;
    s.own = own;
    s.ends[0] = i32(own_length);
    s.ends[1] = s.ends[0] + subgroupShuffle(i32(length), 0u);
    s.ends[2] = s.ends[1] + subgroupShuffle(i32(length), 1u);
    s.ends[3] = s.ends[2] + subgroupShuffle(i32(length), 2u);
    s.ends[4] = s.ends[3] + subgroupShuffle(i32(length), 3u);
    s.ends[5] = s.ends[4] + subgroupShuffle(i32(length), 4u);
    s.ends[6] = s.ends[5] + subgroupShuffle(i32(length), 5u);
    s.ends[7] = s.ends[6] + subgroupShuffle(i32(length), 6u);
    s.total = u32(s.ends[7] + subgroupShuffle(i32(length), 7u));
    s.shifts[0] = subgroupShuffle(begin, 0u) - u32(s.ends[0]);
    s.shifts[1] = subgroupShuffle(begin, 1u) - u32(s.ends[1]);
    s.shifts[2] = subgroupShuffle(begin, 2u) - u32(s.ends[2]);
    s.shifts[3] = subgroupShuffle(begin, 3u) - u32(s.ends[3]);
    s.shifts[4] = subgroupShuffle(begin, 4u) - u32(s.ends[4]);
    s.shifts[5] = subgroupShuffle(begin, 5u) - u32(s.ends[5]);
    s.shifts[6] = subgroupShuffle(begin, 6u) - u32(s.ends[6]);
    s.shifts[7] = subgroupShuffle(begin, 7u) - u32(s.ends[7]);
    return s;
}

// The stretches of the cluster whose particles lie in columns `column`, in lanes from left to right.
fn cluster_stretches(row: u32, lane: u32, column: u32) -> Stretches {
    let others = neighbour_rows() - 1u;
    let lane_row = min(lane + select(0u, 1u, lane >= others / 2u), others);
    let lane_start = neighbour_row(row, lane_row) * row_width();
    let own_start = row * row_width();
    // A cluster that reaches all round the box sees each cell once: the row without its frame.
    let leftmost = subgroupShuffle(column, 0u);
    let rightmost = subgroupShuffle(column, 7u);
    let whole = rightmost - leftmost + 1u + 2u * frame() > CELLS_X;
    let from_cell = select(leftmost, frame(), whole);
    let to_cell = select(rightmost + 1u + 2u * frame(), frame() + CELLS_X, whole);
    let begin = cell_at(lane_start + from_cell);
    let length = select(0u, cell_at(lane_start + to_cell) - begin, lane < others);
    let own = cell_at(own_start + from_cell);
    return stretches_of(own, cell_at(own_start + to_cell) - own, begin, length);
}
