// Visits every pair from both ends, eight particles of a row at a time: the lanes of a subgroup of eight load candidates
// together and pass them on by shuffles. For adapters whose subgroups have eight lanes.

// Words of hits, one bit a candidate, that a lane holds at once.
const WORDS: u32 = 32u;

// The candidates of a cluster of eight particles, nine (three, one) stretches seen as one: the own row first.
struct Stretches {
    own: u32,
    ends: array<i32, 8>, // signed, which the adapter compares in one instruction
    shifts: array<u32, 8>,
    total: u32,
}

// Where a candidate is in the sorted array, from its number.
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

// Lane k holds the stretch of the k-th neighbouring row; all lanes get all of them.
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

// Slot pairs/cluster_rows: the stretches of candidates. The plan chooses `sheared` if the scene has shear.
// Default: the stretches of the cluster whose particles lie in columns `column`, in lanes from left to right.
fn cluster_stretches(row: u32, lane: u32, column: u32) -> Stretches {
    let others = neighbour_rows() - 1u;
    let lane_row = min(lane + select(0u, 1u, lane >= others / 2u), others);
    let lane_start = neighbour_row(row, lane_row) * row_width();
    let own_start = row * row_width();
    // A cluster that extends round the whole box visits each cell once: the row without its frame.
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

// The candidate of this lane among the next eight, loaded while the current ones are examined.
var<private> hits_next: Probe;

// Slot pairs/hits: see pairs/hits. Default: the prefilter, where each lane loads one candidate of eight.
fn prepare_cluster_hits(row: u32, me: Particle, lane: u32, s: Stretches) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
    hits_next = candidate_of_lane(s, lane);
}
fn candidate_of_lane(s: Stretches, candidate: u32) -> Probe {
    return candidate_probe(resolve(s, min(candidate, s.total - 1u)), hits_middle);
}
fn hits_of_cluster(row: u32, index: u32, lane: u32, s: Stretches, base: u32, end: u32) -> u32 {
    var mask = 0u;
    var part = 0u;
    // Ends: part counts to 32.
    loop {
        let next = candidate_of_lane(s, base + part + 8u + lane);
        mask |= eight_hits(hits_probe, lane, hits_next) << part;
        hits_next = next;
        part += 8u;
        if (part >= 32u || base + part >= end) { break; }
    }
    let left = end - base;
    mask &= select(0xffffffffu, (1u << (left & 31u)) - 1u, left < 32u);
    let own_bit = index - s.own - base;
    mask &= ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
    keep_mask(row, index, base / 32u, mask);
    return mask;
}

// One bit for each of the eight candidates that the lanes hold. Lanes exchange theirs in pairs: the adapter does that in
// one instruction, where broadcasting one candidate takes two.
fn eight_hits(probe: Probe, lane: u32, candidate: Probe) -> u32 {
    return select(0u, 1u << lane, probe_hits(probe, candidate))
        | hit_across(probe, lane ^ 1u, candidate) | hit_across(probe, lane ^ 2u, candidate)
        | hit_across(probe, lane ^ 3u, candidate) | hit_across(probe, lane ^ 4u, candidate)
        | hit_across(probe, lane ^ 5u, candidate) | hit_across(probe, lane ^ 6u, candidate)
        | hit_across(probe, lane ^ 7u, candidate);
}
fn hit_across(probe: Probe, lane: u32, candidate: Probe) -> u32 {
    return select(0u, 1u << lane, probe_hits(probe, shuffled(candidate, lane)));
}

// The number of the lowest bit that is set, from the exponent of that bit as a float, which is exact: these adapters
// count bits in software. Any number below 32 where none is set.
fn lowest_bit(word: u32) -> u32 {
    let exponent = bitcast<u32>(f32(bitcast<i32>(word & (~word + 1u)))) >> 23u;
    return (exponent + 1u) & 31u;
}

// Visits every pair from both ends, for subgroups of eight lanes. One lane a particle of a cluster; one workgroup several
// stretches of rows. Reads the sorted particles, `cells` and what the prefilter reads; the pass (slot pairs/pass, see
// pairs/rows) decides what is written.
@compute @workgroup_size(8)
fn visit_clusters(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(subgroup_invocation_id) lane: u32) {
    let group = linear_workgroup(workgroup);
    var masks: array<u32, WORDS>;
    // Loops are left at their ends: software adapters execute what follows a `break` once more in every loop, without effect.
    var part = group * (rows() * SEGMENTS) / SHARES;
    let last_part = (group + 1u) * (rows() * SEGMENTS) / SHARES;
    // Ends: part counts to last_part.
    loop {
        let row = part / SEGMENTS;
        let row_first = row_begin(row);
        let row_last = row_end(row);
        var first = row_first + (part - row * SEGMENTS) * 8u;
        // Ends: first counts to row_last.
        loop {
            if (first < row_last) {
                let index = min(first + lane, row_last - 1u);
                let me = particle_at(index);
                let s = cluster_stretches(row, lane, column_of(fraction_of(me.position)));
                prepare_cluster_hits(row, me, lane, s);
                var sums = pass_begin(me);
                var tile = 0u;
                // Ends: tile counts to s.total.
                loop {
                    let tile_end = min(s.total, tile + 32u * WORDS);
                    var filled = 0u; // one bit a word with hits
                    var word = 0u;
                    // Ends: word counts to the end of the tile.
                    loop {
                        let mask = hits_of_cluster(row, index, lane, s, tile + 32u * word, tile_end);
                        masks[word] = mask;
                        filled |= select(0u, 1u << word, mask != 0u);
                        word++;
                        if (tile + 32u * word >= tile_end) { break; }
                    }
                    word = lowest_bit(filled);
                    var mask = masks[word];
                    // Ends: every turn clears a bit of a mask, and after its last one a bit of `filled`.
                    loop {
                        if (filled != 0u) {
                            let other = resolve(s, tile + 32u * word + lowest_bit(mask));
                            mask &= mask - 1u;
                            pass_pair(&sums, me, other);
                            if (mask == 0u) {
                                filled &= filled - 1u;
                                word = lowest_bit(filled);
                                mask = masks[word];
                            }
                        }
                        if (filled == 0u) { break; }
                    }
                    tile += 32u * WORDS;
                    if (tile >= s.total) { break; }
                }
                if (first + lane < row_last) { pass_end(row, index, me, sums); }
            }
            first += 8u * SEGMENTS;
            if (first >= row_last) { break; }
        }
        part++;
        if (part >= last_part) { break; }
    }
    report_turns(workgroup.x >> 16u);
    pass_finish(group, lane);
}
