// What came through the faces, which is cleared.
var<storage, read_write> exchanges: array<vec4<i32>>; // momentum, mass, energy of each cell

fn take_change(slot: u32) -> vec4<i32> {
    let change = exchanges[slot];
    exchanges[slot] = vec4<i32>(0);
    return change;
}
