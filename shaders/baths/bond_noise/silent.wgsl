// Baths of bonds draw nothing.
fn prepare_bond_noise() {}
