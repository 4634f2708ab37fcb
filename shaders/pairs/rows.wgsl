// Visits every pair from both ends, one invocation a particle, for any subgroup size. Candidates are first turned into masks of
// hits; the hits are visited in a second loop that does little else.
//
// Slot pairs/pass: what is done with particles and pairs. `Sums` is what a particle gathers: `pass_begin` starts it,
// `pass_pair` adds the pair with a sorted particle that may be within the cutoff, `pass_end` finishes the particle;
// `pass_finish` ends the workgroup. Every pair is visited from both ends, which must round the same impulse. Variants: leapfrog
// and observe_leapfrog; find, relax, observe_motion and observe_configuration of split steps; leapfrog_stress, split_stress and
// first_stage_stress for an analysis of the stress. Of split steps also kick, which stands for find where pairs have no friction,
// and those of particles without their pairs: relax_particles, pull_tethers, forget_forces; sum_densities and observe_densities
// before the others, if forces depend on local densities. The plan of particles chooses; no default.

// Words of hits, one bit a candidate, that a lane holds at once: most often those of all its candidates. They lie in workgroup
// memory, as compilers of graphics cards keep an array that is indexed at run time neither in registers nor near them.
const HIT_WORDS: u32 = 8u;
struct LaneHits {
    words: array<u32, 16>, // masks, then the first candidate of each; see word_place
}
var<workgroup> lane_hits: array<LaneHits, WORKGROUP>;

// Where a lane keeps a word: its neighbours keep theirs elsewhere, in other banks of the memory.
fn word_place(lane: u32, word: u32) -> u32 { return word ^ (lane & 15u); }

// Visits one particle and its pairs.
fn visit_particle_of_row(row: u32, index: u32, lane: u32) {
    let me = particle_at(index);
    var search = search_around(row, me);
    var sums = pass_begin(me);
    // Ends: the inner loop goes on until all rows have been searched, or HIT_WORDS more words are filled.
    loop {
        var filled = 0u;
        // Ends: every turn begins a further row, or advances base towards its end.
        while (filled < HIT_WORDS) {
            if (search.base >= search.end) {
                if (search.rows == neighbour_rows()) { break; }
                begin_row(&search, row);
                continue;
            }
            lane_hits[lane].words[word_place(lane, HIT_WORDS + filled)] = search.base;
            let mask = next_hits(&search, row, index);
            lane_hits[lane].words[word_place(lane, filled)] = mask;
            filled += select(0u, 1u, mask != 0u);
        }
        var word = 0u;
        var mask = 0u;
        var word_base = 0u;
        // Ends: every turn clears a bit of a mask, of which there are `filled`. One loop, so that lanes do not wait for each other
        // after every word.
        loop {
            if (mask == 0u) {
                if (word == filled) { break; }
                mask = lane_hits[lane].words[word_place(lane, word)];
                word_base = lane_hits[lane].words[word_place(lane, HIT_WORDS + word)];
                word += 1u;
            }
            pass_pair(&sums, me, word_base + firstTrailingBit(mask));
            mask &= mask - 1u;
        }
        if (search.base >= search.end && search.rows == neighbour_rows()) { break; }
    }
    pass_end(row, index, me, sums);
}

// Visits every pair from both ends, for any subgroup size. One invocation a sorted particle at a time, in chunks that end where
// they are full and not where a row ends: SHARES workgroups have a chunk each in turns. Reads the sorted particles, `cells` and what the
// prefilter reads; the pass decides what is written.
@compute @workgroup_size(WORKGROUP)
fn visit_rows(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let end = select(0u, cell_at(rows() * row_width()), group < SHARES);
    for (var index = group * WORKGROUP + lane; index < end; index += WORKGROUP * SHARES) {
        let row = row_of(fraction_of(position_at(index)));
        // Copies in frames are visited where they are copied from.
        if (index >= row_begin(row) && index < row_end(row)) { visit_particle_of_row(row, index, lane); }
    }
    report_turns(workgroup.x >> 16u);
    pass_finish(group, lane);
}
