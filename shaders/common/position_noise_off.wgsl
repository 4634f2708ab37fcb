// The position baths of this scene have no temperature.
fn prepare_position_noise() {}
fn position_noise(id: u32, species: i32) -> Vector { return Vector(0.0); }
