// A step without a report.
fn note_pair(slot: u32, other_slot: u32, repulsion: f32, magnitude: f32, contact: Contact) {}
fn finish_pairs(group: u32, lane: u32) {}
