// Twice the push through the faces: both halves of a step that has nothing between them.

fn take_change(slot: u32) -> vec4<i32> {
    let change = 2 * pushes[slot];
    pushes[slot] = vec4<i32>(0);
    return change;
}
