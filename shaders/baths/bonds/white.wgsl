// Friction and noise along bonds without memory, Cotter and Reich (18)-(21), doi:10.1209/epl/i2003-00621-8.
fn prepare_bonds() { prepare_bond_noise(); }
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 {
    return -BATH_IMPULSE * (kind.response * change_of_length(me, other) + kind.noise * bond_noise(bond));
}
