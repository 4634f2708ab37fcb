// The force on a particle in units of the impulse; components beyond the box's dimension are zero.
fn sampled(id: u32) -> vec3<f32> { return vec3<f32>(reported_forces[id].xyz); }
