// The stress of listed pairs at a report.
fn note_pair(pair: Ends, c: Coefficients, magnitude: f32, contact: Contact) {
    let push = repulsion_of(c, contact).impulse;
    share_stress(pair.me.position.w, pair.other.position.w, push, magnitude - push, contact);
}
fn finish_pairs(group: u32, lane: u32) {}
