// After a sort: which particles are this rank's own in the step, by slot, and how many are stored: see ranks/domain.
fn pass_begin(me: Particle) -> bool { return lies_in(OWN, me.position); }
fn pass_end(row: u32, index: u32, me: Particle, own: bool) { owned_slots[unframed_index(row, index)] = mark_of(row, index, own); }
fn pass_finish(group: u32, lane: u32) {
    let last = rows() - 1u;
    if (group == 0u && lane == 0u) { atomicStore(&outgoing_counts[PEERS], unframed_index(last, row_end(last))); }
}
