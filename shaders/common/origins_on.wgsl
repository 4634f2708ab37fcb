// Where each particle was stored before, for what its pairs remember.
@group(0) @binding(27) var<storage, read_write> came_from: array<u32>;
fn note_origin(slot: u32, before: u32) { came_from[slot] = before; }
