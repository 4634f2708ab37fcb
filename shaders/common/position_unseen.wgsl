// No bath of a particle has an energy.
fn note_position_bath(species: i32, bath: Vector) {}
