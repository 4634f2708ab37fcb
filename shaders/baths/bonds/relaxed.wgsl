// Friction and noise along bonds at the report of a split step: half of the impulse of the whole step, because a report
// counts those of half a step. See bonds/relaxation.
fn prepare_bonds() {}
fn bond_bath(bond: u32, kind: BondKind, me: Particle, other: Particle) -> f32 { return 0.5 * bond_impulses[bond]; }
