// Visits every pair from both ends, eight particles of a row at a time: the lanes of a subgroup of eight share the
// loading of candidates and hand them round by shuffles. For adapters whose subgroups have eight lanes.
override SEGMENTS: u32; // workgroups that share a row

const WORDS: u32 = 32u;

// The candidates of a cluster, nine (three, one) stretches seen as one: the own row first.
struct Stretches {
    own: u32,
    ends: array<u32, 8>,
    shifts: array<u32, 8>,
    total: u32,
}

fn resolve(s: Stretches, candidate: u32) -> u32 {
    var shift = s.own;
    if (neighbour_rows() > 1u) {
        shift = select(shift, s.shifts[0], candidate >= s.ends[0]);
        shift = select(shift, s.shifts[1], candidate >= s.ends[1]);
    }
    if (neighbour_rows() > 3u) {
        shift = select(shift, s.shifts[2], candidate >= s.ends[2]);
        shift = select(shift, s.shifts[3], candidate >= s.ends[3]);
        shift = select(shift, s.shifts[4], candidate >= s.ends[4]);
        shift = select(shift, s.shifts[5], candidate >= s.ends[5]);
        shift = select(shift, s.shifts[6], candidate >= s.ends[6]);
        shift = select(shift, s.shifts[7], candidate >= s.ends[7]);
    }
    return shift + candidate;
}

// Lane k holds the k-th neighbouring row's stretch; every lane learns them all.
fn stretches_of(own: u32, own_length: u32, begin: u32, length: u32) -> Stretches {
    var s: Stretches;
    s.own = own;
    s.ends[0] = own_length;
    s.ends[1] = s.ends[0] + subgroupShuffle(length, 0u);
    s.ends[2] = s.ends[1] + subgroupShuffle(length, 1u);
    s.ends[3] = s.ends[2] + subgroupShuffle(length, 2u);
    s.ends[4] = s.ends[3] + subgroupShuffle(length, 3u);
    s.ends[5] = s.ends[4] + subgroupShuffle(length, 4u);
    s.ends[6] = s.ends[5] + subgroupShuffle(length, 5u);
    s.ends[7] = s.ends[6] + subgroupShuffle(length, 6u);
    s.total = s.ends[7] + subgroupShuffle(length, 7u);
    s.shifts[0] = subgroupShuffle(begin, 0u) - s.ends[0];
    s.shifts[1] = subgroupShuffle(begin, 1u) - s.ends[1];
    s.shifts[2] = subgroupShuffle(begin, 2u) - s.ends[2];
    s.shifts[3] = subgroupShuffle(begin, 3u) - s.ends[3];
    s.shifts[4] = subgroupShuffle(begin, 4u) - s.ends[4];
    s.shifts[5] = subgroupShuffle(begin, 5u) - s.ends[5];
    s.shifts[6] = subgroupShuffle(begin, 6u) - s.ends[6];
    s.shifts[7] = subgroupShuffle(begin, 7u) - s.ends[7];
    return s;
}

@compute @workgroup_size(8)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(subgroup_invocation_id) lane: u32) {
    let group = linear_workgroup(workgroup, workgroups);
    let row = group / SEGMENTS;
    if (row >= rows()) { return; }
    let middle = row_middle(row);
    let row_first = row_begin(row);
    let row_last = row_end(row);
    let others = neighbour_rows() - 1u;
    let lane_row = min(lane + select(0u, 1u, lane >= others / 2u), others);
    let lane_start = neighbour_row(row, lane_row) * row_width();
    let own_start = row * row_width();
    var masks: array<u32, WORDS>;
    var bases: array<u32, WORDS>;
    for (var first = row_first + (group - row * SEGMENTS) * 8u; first < row_last; first += 8u * SEGMENTS) {
        let index = min(first + lane, row_last - 1u);
        let me = sorted[index];
        let fraction = fraction_of(me.position);
        let probe = probe_of(fraction, middle);
        let column = column_of(fraction);
        // A cluster that reaches all round the box sees each cell once: the row without its frame.
        let leftmost = subgroupShuffle(column, 0u);
        let rightmost = subgroupShuffle(column, 7u);
        let whole = rightmost - leftmost + 1u + 2u * frame() > CELLS_X;
        let from_cell = select(leftmost, frame(), whole);
        let to_cell = select(rightmost + 1u + 2u * frame(), frame() + CELLS_X, whole);
        let begin = cells[lane_start + from_cell];
        let length = select(0u, cells[lane_start + to_cell] - begin, lane < others);
        let own = cells[own_start + from_cell];
        let s = stretches_of(own, cells[own_start + to_cell] - own, begin, length);
        var sums = pass_begin(me);
        for (var tile = 0u; tile < s.total; tile += 32u * WORDS) {
            let tile_end = min(s.total, tile + 32u * WORDS);
            var filled = 0u;
            for (var base = tile; base < tile_end; base += 32u) {
                var mask = 0u;
                for (var part = 0u; part < 32u && base + part < tile_end; part += 8u) {
                    let word = probes[resolve(s, min(base + part + lane, s.total - 1u))];
                    mask |= eight_hits(probe, probe_of_word(word, middle)) << part;
                }
                let left = tile_end - base;
                mask &= select(0xffffffffu, (1u << (left & 31u)) - 1u, left < 32u);
                let own_bit = index - own - base;
                mask &= ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
                masks[filled] = mask;
                bases[filled] = base;
                filled += select(0u, 1u, mask != 0u);
            }
            var word = 0u;
            var mask = masks[0];
            var word_base = bases[0];
            while (word < filled) {
                let other = resolve(s, word_base + firstTrailingBit(mask));
                mask &= mask - 1u;
                pass_pair(&sums, me, other);
                if (mask == 0u) {
                    word += 1u;
                    mask = masks[word & 31u];
                    word_base = bases[word & 31u];
                }
            }
        }
        if (first + lane < row_last) { pass_end(row, index, me, sums); }
    }
}
