// A report of the baths on coordinates: their energies and squares.
fn note_position_bath(species: i32, bath: Vector) {
    for (var axis = 0u; axis < DIMENSION; axis++) {
        let square = bath[axis] * bath[axis];
        observe_bath(square * position_energy(species), square * BATH_SQUARE);
    }
}
