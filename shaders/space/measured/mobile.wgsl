// Particles that can move.
fn is_measured(id: u32) -> bool { return id < PARTICLES && !is_held(stored_particle(id)); }
fn mobile_part(me: Particle) -> f32 { return select(1.0, 0.0, is_held(me)); }
