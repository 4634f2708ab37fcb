// No force of this scene is conservative.
fn add_force(slot: u32, force: Steps) {}
