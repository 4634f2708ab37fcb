// No force of this scene is conservative.
fn conservative_kick(slot: u32, all: Steps) -> Steps { return Steps(0); }
