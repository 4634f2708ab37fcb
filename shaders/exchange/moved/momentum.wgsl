// Momentum crosses the faces.

fn move_units(cell: u32, units: vec4<i32>) {
    atomicAdd(&exchanges[4u * cell + 0u], units.x);
    atomicAdd(&exchanges[4u * cell + 1u], units.y);
}
