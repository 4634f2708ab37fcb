// The stress of listed pairs at a report.
fn note_pair(slot: u32, other_slot: u32, c: Coefficients, magnitude: f32, contact: Contact) {
    let push = repulsion_of(c, contact).impulse;
    share_stress(stored_position(slot).w, stored_position(other_slot).w, push, magnitude - push, contact);
}
fn finish_pairs(group: u32, lane: u32) {}
