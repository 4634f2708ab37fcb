// Particles of a species have the same mass, and those that are held an infinite one.
fn inverse_mass_at(position: vec4<u32>, momentum: vec4<i32>) -> f32 { return yielding_of(species_in(momentum)); }
