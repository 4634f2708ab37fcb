// The hits that an earlier pass kept, in the same words. A particle's words are read before it is stored over them.
fn kept_word(slot: u32, word: u32) -> u32 {
    if (word < 4u) { return particles[slot].position[word]; }
    return bitcast<u32>(particles[slot].momentum[word & 3u]);
}
fn kept_mask(slot: u32, word: u32, count: u32, own_bit: u32) -> u32 {
    if (word < KEPT_WORDS) { return kept_word(slot, word); }
    let all = select(0xffffffffu, (1u << (count & 31u)) - 1u, count < 32u);
    return all & ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
}
