// Friction and noise along bonds: a bath without memory, whose law is in baths/bath.
fn prepare_bonds() { prepare_bond_noise(); }
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 {
    let bath = advanced_bath(0.0, kind.response, change_seen(kind, me, other), kind.noise * bond_noise(bond));
    return impulse_per_bath(1.0) * bath;
}
