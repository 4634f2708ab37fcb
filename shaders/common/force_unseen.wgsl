// Nobody asks for the force on each particle.
fn note_force(id: u32, kick: Steps) {}
