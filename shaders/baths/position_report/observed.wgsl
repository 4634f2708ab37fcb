// A report of the baths on coordinates: their energies and squares.
fn note_position_bath(species: i32, bath: Vector) {
    for (var axis = 0u; axis < DIMENSION; axis++) {
        report_bath(bath[axis], 1.0, position_energy(species));
    }
}
