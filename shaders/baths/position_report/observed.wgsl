// A report of the baths on coordinates: their energies and squares.
fn reduce_position_baths(group: u32, lane: u32) { reduce_totals(group, lane, SUM_BATH_ENERGY, SUM_BATH_COUNT); }
fn note_position_bath(species: i32, bath: Vector) {
    for (var axis = 0u; axis < DIMENSION; axis++) {
        report_bath(bath[axis], 1.0, position_energy(species));
    }
}
