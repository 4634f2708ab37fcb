// A report of bonds where a split step measures the motion: the virial of all forces.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    if (is_own(bond.me.position)) { note_virial_of_bond(bond, magnitude, contact); }
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }
