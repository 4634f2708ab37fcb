// A step without a report.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {}
fn finish_bonds(group: u32, lane: u32) {}
