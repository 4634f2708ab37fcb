// A report of the baths on coordinates: their energies and squares.
fn note_position_bath(species: i32, bath: Vector) {
    for (var axis = 0u; axis < DIMENSION; axis++) {
        observe_bath(energy_of_position_bath(species, bath[axis]), bath[axis] * bath[axis] * BATH_SQUARE);
    }
}
