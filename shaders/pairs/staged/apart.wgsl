// Momenta alone, in a texture: positions stay where they are.
fn stage(index: u32, particle: Particle) { put_staged_momentum(index, particle.momentum); }
