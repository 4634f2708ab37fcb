// What came through the faces, with the push of the other half of the step; both are cleared.
var<storage, read_write> exchanges: array<vec4<i32>>; // momentum, mass, energy of each cell

fn take_change(slot: u32) -> vec4<i32> {
    let change = exchanges[slot] + pushes[slot];
    exchanges[slot] = vec4<i32>(0);
    pushes[slot] = vec4<i32>(0);
    return change;
}
