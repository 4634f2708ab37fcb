// Conservative impulses are gathered beside those of all forces, see couplings/forces.
fn conservative_kick(slot: u32, all: Steps) -> Steps {
    let kick = steps_of(forces[slot]);
    forces[slot] = vec4<i32>(0);
    return kick;
}
