// Velocities relative to that of the centre of mass at the same step.
fn in_frame(velocity: vec3<f32>) -> vec3<f32> { return velocity - centre[0].xyz; }
