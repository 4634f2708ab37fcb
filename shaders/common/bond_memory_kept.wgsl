// The step goes on: what the bath of a bond has become is kept.
fn note_bond_bath(bond: u32, kind: BondKind, bath: f32) { bond_baths[bond] = select(0.0, bath, kind.remembers); }
