// The bath of pairs has no temperature.
fn prepare_noise() {}
fn bath_noise(id: u32, other: u32) -> f32 { return 0.0; }
