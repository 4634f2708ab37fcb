// Where each particle is stored, by id, for bonds and angles.
fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
