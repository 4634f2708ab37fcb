// The stress of excluded pairs at a report, which is taken back.
fn note_excluded(pair: vec2<u32>, repulsion: Repulsion, contact: Contact) {
    share_stress(pair.x, pair.y, -repulsion.impulse, 0.0, contact);
}
fn finish_exclusions(group: u32, lane: u32) {}
