fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
