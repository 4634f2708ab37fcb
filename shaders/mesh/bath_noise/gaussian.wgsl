// The bath of this scene has a temperature.
override BATH_NOISE: f32;
fn mesh_noise(node: u32) -> f32 { return BATH_NOISE * pair_noise(0u, node); }
