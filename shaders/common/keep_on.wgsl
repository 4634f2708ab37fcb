// A later pass visits the same pairs again.
fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {
    if (word < KEPT_WORDS) { found[word * PARTICLES + unframed_index(row, index)] = mask; }
}
