// The impulses that couplings have added, by sorted particle.
fn gathered_kick(slot: u32) -> Steps { return steps_of(kicks[slot]); }
fn take_gathered_kick(slot: u32) -> Steps {
    let kick = steps_of(kicks[slot]);
    kicks[slot] = vec4<i32>(0);
    return kick;
}
