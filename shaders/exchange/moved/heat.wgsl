// Only energy crosses the faces.
var<storage, read_write> exchanges: array<i32>; // momentum, mass, energy of each cell

fn move_units(cell: u32, units: vec4<i32>) {
    atomicAdd(&exchanges[4u * cell + 3u], units.w);
}
