// A bath with exponential memory on every bond, Cotter and Reich (14)-(17), doi:10.1209/epl/i2003-00621-8. Where some kinds of
// bonds have memory, those without forget everything in a step.

// Over its quantum.
fn energy_of_bond_bath(kind: BondKind, bath: f32) -> f32 { return bath * bath * kind.bath_energy; }
fn prepare_bonds() { prepare_bond_noise(); }
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 {
    let before = bond_baths[bond];
    let after = before - kind.loss * before + kind.response * change_of_length(me, other)
        + kind.noise * bond_noise(bond);
    // At step 0 a bath with memory keeps its initial value.
    let bath = select(after, before, kind.remembers && clock_closing() == 0);
    note_bond_bath(bond, kind, bath);
    return -BATH_IMPULSE * bath;
}
