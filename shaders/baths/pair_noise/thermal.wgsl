// The baths of pairs have a temperature.
fn bath_noise(id: u32, other: u32) -> f32 { return pair_noise(id, other); }
