// The force on each particle, for an analysis: impulses of half a step by all couplings.
@group(0) @binding(41) var<storage, read_write> reported_forces: array<vec4<i32>>;
fn note_force(id: u32, kick: Steps) { reported_forces[id] = momentum_word(kick, 0); }
