// Nobody asks where a particle is stored.
fn note_slot(id: u32, slot: u32) {}
