// Pairs draw nothing.
fn prepare_pair_noise() {}
