fn prepare_bonds() { prepare_bond_noise(); }
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 {
    return -BATH_IMPULSE * (kind.response * change_of_length(me, other) + kind.noise * bond_noise(bond));
}
