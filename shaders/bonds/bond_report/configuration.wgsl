// A report of bonds where a split step measures the configuration.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    if (is_own(bond.me.position)) { note_configuration_of_bond(bond, stretch, contact); }
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }
