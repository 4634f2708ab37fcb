// Each particle has its own mass, in integer units, in the third word of its position.
fn inverse_mass_at(position: vec4<u32>, momentum: vec4<i32>) -> f32 { return 1.0 / (f32(position.z) * MASS_UNIT); }
