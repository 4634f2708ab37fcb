// Only energy crosses the faces.

fn move_units(cell: u32, units: vec4<i32>) {
    atomicAdd(&exchanges[4u * cell + 3u], units.w);
}
