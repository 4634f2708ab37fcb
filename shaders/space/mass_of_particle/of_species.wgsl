// Particles of a species have the same mass.
fn inverse_mass_at(position: vec4<u32>, momentum: vec4<i32>) -> f32 { return inverse_mass_of(momentum.w); }
