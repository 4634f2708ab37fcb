// Where each particle is stored, for bonds between numbered particles.
@group(0) @binding(33) var<storage, read_write> slots: array<u32>;
fn note_slot(id: u32, slot: u32) { slots[id] = slot; }
