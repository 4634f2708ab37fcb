// Of several ranks: as many as are stored, without those that were forgotten, which get no rank in any cell.
const NO_RANK: u32 = 0xffffffffu;

fn stored_count() -> u32 { return stored_number; }
// After a sort, which leaves out those that are forgotten.
fn sorted_count() -> u32 { return atomicLoad(&outgoing_counts[PEERS]); }
fn is_own(position: vec4<u32>) -> bool { return position.w != NOBODY && lies_in(OWN, position); }
fn forgets(index: u32) -> bool {
    // What stays where it was has been counted.
    if (is_inner(index)) { return true; }
    let forgotten = stored_position(index).w == NOBODY;
    if (forgotten) { put_rank(index, NO_RANK); }
    return forgotten;
}
fn has_no_rank(rank: u32) -> bool { return rank == NO_RANK; }
