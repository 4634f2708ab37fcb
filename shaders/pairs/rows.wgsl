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
    begin_visit(row, me);
    prepare_row_hits(row, me);
    let columns = columns_of(me);
    let place = place_of_row(row);
    var sums = pass_begin(me);
    var word_number = 0u;
    var neighbour = 0u;
    var base = 0u;
    var end = 0u;
    // Ends: the inner loop goes on until all rows have been searched, or HIT_WORDS more words are filled.
    loop {
        var filled = 0u;
        // Ends: every turn begins a further row, or advances base towards its end.
        while (filled < HIT_WORDS) {
            if (base >= end) {
                if (neighbour == neighbour_rows()) { break; }
                let other_row = row_near(place, neighbour);
                let start = other_row * row_width() + column_towards(row, other_row, columns);
                base = cell_at(start);
                end = cell_at(start + 2u * frame() + 1u);
                neighbour += 1u;
                continue;
            }
            let mask = hits_of_row(row, index, word_number, base, min(32u, end - base));
            word_number += 1u;
            lane_hits[lane].words[word_place(lane, filled)] = mask;
            lane_hits[lane].words[word_place(lane, HIT_WORDS + filled)] = base;
            filled += select(0u, 1u, mask != 0u);
            base += 32u;
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
        if (base >= end && neighbour == neighbour_rows()) { break; }
    }
    pass_end(row, index, me, sums);
}

// Slot pairs/hits: see pairs/hits. Default: the prefilter, candidate by candidate.
fn prepare_row_hits(row: u32, me: Particle) {
    hits_middle = row_middle(row);
    hits_probe = probe_of(fraction_of(me.position), hits_middle);
}
fn hits_of_row(row: u32, index: u32, word: u32, base: u32, count: u32) -> u32 {
    var mask = 0u;
    // From the last to the first, which is the lowest bit.
    for (var left = count; left > 0u; left--) {
        mask = (mask << 1u) | hit_of(hits_probe, candidate_probe(base + left - 1u, hits_middle));
    }
    let own = index - base;
    mask &= ~select(0u, 1u << (own & 31u), own < 32u);
    keep_mask(row, index, word, mask);
    return mask;
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
