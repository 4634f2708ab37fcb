// The stress of bonds at a report.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    share_stress(bond.me.position.w, bond.other.position.w, stretch.force, magnitude - stretch.force, contact);
}
fn finish_bonds(group: u32, lane: u32) {}
