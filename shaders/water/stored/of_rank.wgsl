// Of several ranks: the places in use, but those whose particles have gone to other ranks. What has arrived lies behind the sorted ones.
fn first_uncounted() -> u32 { return sorted_count(); }
fn holds_water(index: u32) -> bool { return index < stored_count() && load_water(index).id != NOBODY; }
fn ordered_count() -> u32 { return cells[CELLS_X * CELLS_Y - 1u]; }

// How many places the sort has looked at, and how many are left when particles have been put in order.
fn note_ordered(index: u32) {
    if (index == 0u) { atomicStore(&outgoing_counts[PEERS], stored_count()); }
}
fn note_tidied(index: u32) {
    if (index == 0u) { atomicStore(&outgoing_counts[PEERS], ordered_count()); }
}
