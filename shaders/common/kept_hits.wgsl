// The hits that an earlier pass kept, in the same words.
fn prepare_hits(row: u32, me: Particle) {}
fn kept_mask(slot: u32, word: u32, count: u32, own_bit: u32) -> u32 {
    if (word < KEPT_WORDS) { return found[word * PARTICLES + slot]; }
    let all = select(0xffffffffu, (1u << (count & 31u)) - 1u, count < 32u);
    return all & ~select(0u, 1u << (own_bit & 31u), own_bit < 32u);
}
