// Twice the push through the faces: both halves of a step that has nothing between them.
var<storage, read_write> pushes: array<vec4<i32>>; // momentum of each cell

fn take_change(slot: u32) -> vec4<i32> {
    let change = 2 * pushes[slot];
    pushes[slot] = vec4<i32>(0);
    return change;
}
