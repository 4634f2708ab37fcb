// A bath with exponential memory on every bond; its law is in baths/bath. Where some kinds of bonds have memory, those
// without forget everything in a step.
fn prepare_bonds() { prepare_bond_noise(); }
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 {
    let before = bond_baths[bond];
    let after = advanced_bath(kept_of_bath(before, kind.loss), kind.response, change_of_length(kind, me, other),
        kind.noise * bond_noise(bond));
    // At step 0 a bath with memory keeps its initial value.
    let bath = select(after, before, kind.remembers && clock_closing() == 0);
    note_bond_bath(bond, kind, bath);
    return impulse_per_bath(1.0) * bath;
}
