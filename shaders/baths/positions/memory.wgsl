// A bath with exponential memory on every coordinate, Cotter and Reich (14)-(17), doi:10.1209/epl/i2003-00621-8.
override POSITION_IMPULSE: f32; // impulse of half a step per bath
override POSITION_LOSS: f32;    // the part of a bath that is lost in a step

// Of one coordinate, over its quantum.
fn energy_of_position_bath(species: i32, bath: f32) -> f32 { return bath * bath * position_energy(species); }
fn position_bath(id: u32, species: i32, drift: Vector) -> Vector {
    let before = bath_of(position_baths[id]);
    let after = before - POSITION_LOSS * before + position_response(species) * drift + position_noise(id, species);
    // At step 0 the bath keeps its initial value.
    return select(before, after, clock_closing() == 1);
}
fn position_impulse(bath: Vector) -> Vector { return -POSITION_IMPULSE * bath; }
fn keep_position_bath(id: u32, bath: Vector) { position_baths[id] = bath_word(bath); }
