// The stress of excluded pairs at a report, which is taken back.
fn note_excluded(pair: Ends, repulsion: Repulsion, contact: Contact) {
    share_stress(pair.me.position.w, pair.other.position.w, -repulsion.impulse, 0.0, contact);
}
fn finish_exclusions(group: u32, lane: u32) {}
