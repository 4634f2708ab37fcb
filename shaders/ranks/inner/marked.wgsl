// Those in inner cells are marked, and left alone where the others are sent and counted: see pairs/rows_of_part.
fn mark_of(row: u32, index: u32, own: bool) -> u32 {
    let inner = inner_of_row(row);
    return select(select(0u, 1u, own), INNER, (index >= inner.x) & (index < inner.y));
}
fn is_inner(slot: u32) -> bool { return slot < sorted_count() && owned_slots[slot] == INNER; }
