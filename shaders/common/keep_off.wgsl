// No later pass needs the hits again.
fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {}
