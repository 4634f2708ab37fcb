// Friction and noise without memory on every coordinate, Cotter and Reich (18)-(21), doi:10.1209/epl/i2003-00621-8: the
// friction is of the last drift.
override POSITION_IMPULSE: f32; // impulse of half a step per bath

fn position_bath(id: u32, species: i32, drift: Vector) -> Vector {
    return position_response(species) * drift + position_noise(id, species);
}
fn position_impulse(bath: Vector) -> Vector { return -POSITION_IMPULSE * bath; }
fn keep_position_bath(id: u32, bath: Vector) {}
