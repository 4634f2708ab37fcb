// Cells as they are when the exchange begins.
@group(0) @binding(15) var<storage, read_write> volumes: array<f32>;

fn side_of(slot: u32, cell: Particle) -> Side {
    let velocity = velocity_of(cell);
    let mass = mass_of(cell);
    let volume = volumes[slot];
    let pressure = pressure_of(cell, volume);
    return Side(cell.position.w, mass, velocity, velocity, pressure, mass / volume, energy_density_of(cell, volume),
        temperature_of(cell));
}
