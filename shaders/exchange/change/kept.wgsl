// The push through the faces, which stays for the other half of the step.

fn take_change(slot: u32) -> vec4<i32> { return pushes[slot]; }
