// A report reads the baths of bonds and leaves them as they are.
fn note_bond_bath(bond: u32, kind: BondKind, bath: f32) {
    if (kind.remembers) { observe_bath(energy_of_bond_bath(kind, bath), bath * bath * BATH_SQUARE); }
}
