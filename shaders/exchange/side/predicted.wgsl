// Cells as they are when the exchange begins, with the mean velocity and the pressure that exchange/predict expects.
fn side_of(slot: u32, cell: Particle) -> Side {
    let prediction = predictions[slot];
    let mass = mass_of(cell);
    let volume = prediction.w;
    return Side(cell.position.w, mass, velocity_of(cell), prediction.xy, prediction.z, mass / volume,
        energy_density_of(cell, volume), temperature_of(cell));
}
