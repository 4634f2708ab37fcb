// What a cell brings to an exchange through its faces.
struct Side {
    id: u32,
    mass: f32,
    velocity: Vector,    // when the exchange begins
    mean: Vector,        // of before and after it
    pressure: f32,
    density: f32,        // of mass
    energy_density: f32, // of internal energy
    temperature: f32,
}
