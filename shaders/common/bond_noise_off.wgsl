// The baths of bonds have no temperature.
fn prepare_bond_noise() {}
fn bond_noise(bond: u32) -> f32 { return 0.0; }
