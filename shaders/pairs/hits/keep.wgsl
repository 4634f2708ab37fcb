// The hits that the prefilter finds are stored, because a later pass visits the same pairs.
var<storage, read_write> kept_masks: array<array<u32, KEPT_WORDS>>; // the buffer of the particles

fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {
    if (word < KEPT_WORDS) { kept_masks[unframed_index(row, index)][word] = mask; }
}
