// The hits that an earlier pass stored are read, in the same words. A particle's words are read before it is stored over them.
fn kept_word(slot: u32, word: u32) -> u32 {
    if (word < 4u) { return particles[slot].position[word]; }
    return bitcast<u32>(particles[slot].momentum[word & 3u]);
}
fn kept_mask(slot: u32, word: u32, count: u32, own_bit: u32) -> u32 {
    if (word < KEPT_WORDS) { return kept_word(slot, word); }
    let all = select(0xffffffffu, (1u << (count & 31u)) - 1u, count < 32u);
    return all & ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
}

// Of a particle among a stretch of candidates.
fn prepare_row_hits(row: u32, me: Particle) {}
fn hits_of_row(row: u32, index: u32, word: u32, base: u32, count: u32) -> u32 {
    return kept_mask(unframed_index(row, index), word, count, index - base);
}

// Of eight particles among their common candidates.
fn prepare_cluster_hits(row: u32, me: Particle, lane: u32, s: Stretches) {}
fn hits_of_cluster(row: u32, index: u32, lane: u32, s: Stretches, base: u32, end: u32) -> u32 {
    return kept_mask(unframed_index(row, index), base / 32u, end - base, index - s.own - base);
}
