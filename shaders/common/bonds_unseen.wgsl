// A step without a report.
fn note_bond(slot: u32, other_slot: u32, stretch: Stretch, magnitude: f32, contact: Contact) {}
fn finish_bonds(group: u32, lane: u32) {}
