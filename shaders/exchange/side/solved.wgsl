// Cells with the mean velocity of before and after friction, as the solver found it.
fn side_of(slot: u32, cell: Particle) -> Side {
    let mean = estimates[slot].xy;
    return Side(cell.position.w, mass_of(cell), mean, mean, 0.0, 0.0, 0.0, temperature_of(cell));
}
