// Noise of the baths of bonds: a Gaussian number for each.
override BOND_STREAM_X: u32; // key of the stream over all steps
override BOND_STREAM_Y: u32;
var<private> bond_key: vec2<u32>;

fn prepare_bond_noise() { bond_key = threefry2x32(clock_step(), vec2<u32>(BOND_STREAM_X, BOND_STREAM_Y)); }
fn bond_noise(bond: u32) -> f32 { return gaussian_of(pair_words(bond_key, vec2<u32>(bond, 0u))); }
