// Particles as they are stored: nothing orders them by cell at every step.
fn position_at(index: u32) -> vec4<u32> { return stored_position(index); }
fn momentum_at(index: u32) -> vec4<i32> { return stored_momentum(index); }
fn particle_at(index: u32) -> Particle { return stored_particle(index); }
fn sort_particle(index: u32, particle: Particle) { store_particle(index, particle); }
fn keep_momentum(index: u32, momentum: vec4<i32>) { replace_stored_momentum(index, momentum); }
