// No bath acts on particles by themselves.
fn position_bath(id: u32, species: i32, drift: Vector) -> Vector { return Vector(0.0); }
fn position_impulse(bath: Vector) -> Vector { return bath; }
fn keep_position_bath(id: u32, bath: Vector) {}
