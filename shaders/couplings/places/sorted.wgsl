// Particles as they are sorted.
fn particle_in(slot: u32) -> Particle { return particle_at(slot); }
