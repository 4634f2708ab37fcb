// The hits of a particle among a stretch of candidates, as an earlier pass found them.
fn prepare_hits(row: u32, me: Particle) {}
fn hits_of_row(row: u32, index: u32, word: u32, base: u32, count: u32) -> u32 {
    return kept_mask(unframed_index(row, index), word, count, index - base);
}
