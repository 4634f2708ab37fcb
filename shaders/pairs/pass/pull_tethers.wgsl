// Tethers: the impulse of half a step is added to `kicks`, as that of other couplings. The law is in bonds/tethers.
fn pass_begin(me: Particle) -> Vector { return separation(me.position, tethers[me.position.w]); }
fn pass_end(row: u32, index: u32, me: Particle, length: Vector) {
    let impulse = impulse_of_tether(length);
    add_kick(index, Steps(round(impulse)));
    raise(select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT)));
    if (is_own(me.position)) { note_tether(index, me, length); }
}
fn pass_finish(group: u32, lane: u32) { finish_tethers(group, lane); }
