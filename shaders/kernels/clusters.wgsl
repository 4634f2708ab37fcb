// Visits every pair from both ends, eight particles of a row at a time: the lanes of a subgroup of eight share the
// loading of candidates and hand them round by shuffles. For adapters whose subgroups have eight lanes.
override SEGMENTS: u32; // parts of a row
override SHARES: u32; // workgroups that share all parts of all rows, as many of them each

const WORDS: u32 = 32u;

@compute @workgroup_size(8)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(subgroup_invocation_id) lane: u32) {
    let group = linear_workgroup(workgroup);
    var masks: array<u32, WORDS>;
    // Loops are left at their ends: software adapters execute what follows a `break` for nobody, once more in every loop.
    var part = group * (rows() * SEGMENTS) / SHARES;
    let last_part = (group + 1u) * (rows() * SEGMENTS) / SHARES;
    loop {
        let row = part / SEGMENTS;
        let row_first = row_begin(row);
        let row_last = row_end(row);
        var first = row_first + (part - row * SEGMENTS) * 8u;
        loop {
            if (first < row_last) {
                let index = min(first + lane, row_last - 1u);
                let me = particle_at(index);
                let s = cluster_stretches(row, lane, column_of(fraction_of(me.position)));
                prepare_hits(row, me, lane, s);
                var sums = pass_begin(me);
                var tile = 0u;
                loop {
                    let tile_end = min(s.total, tile + 32u * WORDS);
                    var filled = 0u; // one bit a word with hits
                    var word = 0u;
                    loop {
                        let mask = hits_of_cluster(row, index, lane, s, tile + 32u * word, tile_end);
                        masks[word] = mask;
                        filled |= select(0u, 1u << word, mask != 0u);
                        word++;
                        if (tile + 32u * word >= tile_end) { break; }
                    }
                    word = lowest_bit(filled);
                    var mask = masks[word];
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

// The number of the lowest bit that is set, read off the exponent of that bit as a float, which is exact: these adapters
// count bits in software. Any number below 32 where none is set.
fn lowest_bit(word: u32) -> u32 {
    let exponent = bitcast<u32>(f32(bitcast<i32>(word & (~word + 1u)))) >> 23u;
    return (exponent + 1u) & 31u;
}
