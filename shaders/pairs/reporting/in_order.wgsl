// Of several ranks each leaves its particles in the order in which they are stored.
fn reported_place(row: u32, index: u32, id: u32) -> u32 { return unframed_index(row, index); }
