// The hits that the prefilter finds are stored, because a later pass visits the same pairs.

fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {
    if (word < KEPT_WORDS) { kept_masks[unframed_index(row, index)][word] = mask; }
}
