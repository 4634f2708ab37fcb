// Cells as they are when the exchange begins.
fn side_of(slot: u32, cell: Particle) -> Side {
    let velocity = velocity_of(cell);
    let mass = mass_of(cell);
    let volume = volumes[slot];
    let pressure = pressure_of(cell, volume);
    return Side(cell.position.w, mass, velocity, velocity, pressure, mass / volume, energy_density_of(cell, volume),
        temperature_of(cell));
}
