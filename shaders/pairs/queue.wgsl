// Visits every pair from both ends, for any subgroup size, with all lanes of a workgroup at work: lanes find the hits
// of a particle each and append them to a queue in workgroup memory, from which every lane takes pairs of whatever
// particle. Sums of pairs are integers, so that neither the order of additions nor the lane that adds matters. See
// pairs/rows for the same with the pairs of a particle in one lane, which reports and passes with other sums need.
//
// Slot pairs/pass, beyond pairs/rows: `queue_sums` adds what a pair has given to the sums of the particle of a lane,
// and `queued_sums` are these. They have QUEUED_SUMS words.

// Words of hits, one bit a candidate, that a lane finds before pairs are visited: more than half of the rows around a
// particle, so that two rounds are enough most often.
const ROUND_WORDS: u32 = 5u;
override QUEUE_ENTRIES: u32; // of the queue: several for a lane
override HIT_PLACES: u32;    // two of each word of every lane

struct QueuedSums { words: array<atomic<i32>, QUEUED_SUMS> }

// The words of all lanes, word by word, then the first candidate of each.
var<workgroup> hit_words: array<u32, HIT_PLACES>;
// Entries: the bit of a hit, its word, and the lane whose particle has it. The place of a candidate among all particles
// would not fit.
var<workgroup> queue: array<u32, QUEUE_ENTRIES>;
var<workgroup> sums_of_lanes: array<QueuedSums, WORKGROUP>;
var<workgroup> hits_of_lanes: atomic<u32>;   // hits of all lanes, and GOES_ON if a lane has more to search
var<workgroup> shared_word: u32;     // what all lanes of a workgroup have to know alike
const GOES_ON: u32 = 0x80000000u;

fn queue_steps(lane: u32, word: u32, steps: Steps) {
    for (var axis = 0u; axis < DIMENSION; axis++) { atomicAdd(&sums_of_lanes[lane].words[word + axis], steps[axis]); }
}
fn queued_steps(lane: u32, word: u32) -> Steps {
    var steps = Steps(0);
    for (var axis = 0u; axis < DIMENSION; axis++) { steps[axis] = atomicLoad(&sums_of_lanes[lane].words[word + axis]); }
    return steps;
}
fn queue_word(lane: u32, word: u32, value: u32) { atomicAdd(&sums_of_lanes[lane].words[word], bitcast<i32>(value)); }
fn queued_word(lane: u32, word: u32) -> u32 { return bitcast<u32>(atomicLoad(&sums_of_lanes[lane].words[word])); }

// A strain, of which the sum is only compared with its limit: in whole units that are small beside that, rounded up. A
// strain beyond the limit, or that is not a number, is the limit.
const STRAIN_UNIT: f32 = 256.0;
fn queue_strain(lane: u32, word: u32, strain: f32) {
    let bounded = select(STRAIN_LIMIT, strain, is_within(strain, STRAIN_LIMIT));
    queue_word(lane, word, u32(bounded * (1.0 / STRAIN_UNIT) + 1.0));
}
fn queued_strain(lane: u32, word: u32) -> f32 { return f32(queued_word(lane, word)) * STRAIN_UNIT; }

// A pair of the queue, visited by the lane that has taken it.
fn visit_queued(first: u32, entry: u32) {
    let lane = entry >> 8u;
    let place = ((entry >> 5u) & 7u) * WORKGROUP + lane;
    let other = hit_words[ROUND_WORDS * WORKGROUP + place] + (entry & 31u);
    let me = particle_at(first + lane);
    begin_visit(row_of(fraction_of(me.position)), me);
    var sums: Sums;
    pass_pair(&sums, me, other);
    queue_sums(lane, sums);
}

// Visits the sorted particles from `first` on, one a lane; there are `end` in all.
fn visit_queue_of_chunk(first: u32, end: u32, lane: u32) {
    let index = min(first + lane, end - 1u);
    let me = particle_at(index);
    let row = row_of(fraction_of(me.position));
    // Copies in frames are visited where they are copied from.
    let is_visited = first + lane < end && index >= row_begin(row) && index < row_end(row);
    var search = search_around(row, me);
    pass_begin(me);
    for (var word = 0u; word < QUEUED_SUMS; word++) { atomicStore(&sums_of_lanes[lane].words[word], 0); }
    if (lane == 0u) { atomicStore(&hits_of_lanes, 0u); }
    workgroupBarrier();
    let rows_to_search = select(0u, neighbour_rows(), is_visited);
    // Ends: in every round each lane that has more to search goes on by a row, or by 32 candidates of one.
    loop {
        var count = 0u;
        for (var word = 0u; word < ROUND_WORDS; word++) {
            if (search.base >= search.end && search.rows < rows_to_search) { begin_row(&search, row); }
            hit_words[(ROUND_WORDS + word) * WORKGROUP + lane] = search.base;
            var mask = 0u;
            if (search.base < search.end) { mask = next_hits(&search, row, index); }
            hit_words[word * WORKGROUP + lane] = mask;
            count += countOneBits(mask);
        }
        let goes_on = search.base < search.end || search.rows < rows_to_search;
        var place = atomicAdd(&hits_of_lanes, count) & ~GOES_ON;
        if (goes_on) { atomicOr(&hits_of_lanes, GOES_ON); }
        workgroupBarrier();
        if (lane == 0u) { shared_word = atomicExchange(&hits_of_lanes, 0u); }
        let all = workgroupUniformLoad(&shared_word);
        let last = place + count;
        var word = 0u;
        var mask = hit_words[lane];
        for (var window = 0u; window < (all & ~GOES_ON); window += QUEUE_ENTRIES) {
            let window_end = window + QUEUE_ENTRIES;
            // Ends: every turn goes on to the next word or appends a hit.
            while (place < min(last, window_end)) {
                if (mask == 0u) {
                    word += 1u;
                    mask = hit_words[word * WORKGROUP + lane];
                }
                if (mask != 0u) {
                    queue[place - window] = (lane << 8u) | (word << 5u) | firstTrailingBit(mask);
                    mask &= mask - 1u;
                    place += 1u;
                }
            }
            workgroupBarrier();
            let queued = min((all & ~GOES_ON) - window, QUEUE_ENTRIES);
            for (var taken = lane; taken < queued; taken += WORKGROUP) { visit_queued(first, queue[taken]); }
            workgroupBarrier();
        }
        if ((all & GOES_ON) == 0u) { break; }
        begin_visit(row, me);
    }
    if (is_visited) { pass_end(row, index, me, queued_sums(lane)); }
}

// Visits every pair from both ends. Each workgroup has chunks of sorted particles in turns, one particle a lane; see
// visit_rows.
@compute @workgroup_size(WORKGROUP)
fn visit_queue(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    if (lane == 0u) { shared_word = select(0u, cell_at(rows() * row_width()), group < SHARES); }
    let end = workgroupUniformLoad(&shared_word);
    for (var first = group * WORKGROUP; first < end; first += WORKGROUP * SHARES) {
        visit_queue_of_chunk(first, end, lane);
    }
    report_turns(workgroup.x >> 16u);
    pass_finish(group, lane);
}
