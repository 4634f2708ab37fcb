// Where each particle was stored before the sort, for what its pairs remember.
fn note_origin(slot: u32, before: u32) { came_from[slot] = before; }
