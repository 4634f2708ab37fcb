// A report reads the baths of bonds and leaves them as they are.
fn note_bond_bath(bond: u32, kind: BondKind, bath: f32) {
    if (kind.remembers) { report_bath(bath, 1.0, kind.bath_energy); }
}
