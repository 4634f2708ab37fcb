// The push through the faces, which stays for the other half of the step.
var<storage, read_write> pushes: array<vec4<i32>>; // momentum of each cell

fn take_change(slot: u32) -> vec4<i32> { return pushes[slot]; }
