// The bath of pairs has a temperature.
fn bath_noise(id: u32, other: u32) -> f32 { return pair_noise(id, other); }
