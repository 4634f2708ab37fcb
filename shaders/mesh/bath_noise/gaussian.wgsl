// Noise of a bath with a temperature: a Gaussian number for every node.
override BATH_NOISE: f32;

fn prepare_mesh_noise() { prepare_pair_noise(); }
fn mesh_noise(node: u32) -> f32 { return BATH_NOISE * pair_noise(0u, node); }
