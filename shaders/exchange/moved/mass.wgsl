// Momentum and mass cross the faces.
var<storage, read_write> exchanges: array<i32>; // momentum, mass, energy of each cell

fn move_units(cell: u32, units: vec4<i32>) {
    atomicAdd(&exchanges[4u * cell + 0u], units.x);
    atomicAdd(&exchanges[4u * cell + 1u], units.y);
    atomicAdd(&exchanges[4u * cell + 2u], units.z);
}
