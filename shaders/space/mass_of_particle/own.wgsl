// Particles that each have their own mass, in integer units beside their place.
fn inverse_mass_at(position: vec4<u32>, momentum: vec4<i32>) -> f32 { return 1.0 / (f32(position.z) * MASS_UNIT); }
