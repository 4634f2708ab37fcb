// Cells that exchange nothing but heat.
fn side_of(slot: u32, cell: Particle) -> Side {
    return Side(cell.position.w, mass_of(cell), Vector(0.0), Vector(0.0), 0.0, 0.0, 0.0, temperature_of(cell));
}
