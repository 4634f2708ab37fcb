// Where each particle is stored, for bonds between numbered particles.
fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
