// Walks of molecules, which may branch: `chain_walks` lists the particles, and marks those to which a walk goes back.
fn particle_on_walk(step: u32) -> u32 { return chain_walks[step] & 0x7fffffffu; }
fn is_revisited(step: u32) -> bool { return (chain_walks[step] >> 31u) != 0u; }
