// Of one of several ranks: where each particle that it knows is sorted, by id; the others are nowhere.
fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
fn forget_slot(id: u32) { slots[id] = NOWHERE; }
