// A report of bonds: motion and configuration.
fn note_bond(bond: Ends, stretch: Stretch, magnitude: f32, contact: Contact) {
    gather_force_of_bond(bond, stretch, contact);
    if (!is_own(bond.me.position)) { return; }
    note_virial_of_bond(bond, magnitude, contact);
    note_configuration_of_bond(bond, stretch, contact);
}
fn finish_bonds(group: u32, lane: u32) { total_reduce(group, lane); }
