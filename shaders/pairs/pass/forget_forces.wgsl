// Clears the forces of the last report, where the baths of a split step add to them before anything else is reported.
fn pass_begin(me: Particle) -> Steps { return Steps(0); }
fn pass_end(row: u32, index: u32, me: Particle, none: Steps) {
    begin_force();
    store_force(me.position.w);
}
fn pass_finish(group: u32, lane: u32) {}
