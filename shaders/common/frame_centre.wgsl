// Velocities relative to that of the centre of mass at the same step.
@group(0) @binding(42) var<storage, read_write> centre: array<vec4<f32>>;

fn in_frame(velocity: vec3<f32>) -> vec3<f32> { return velocity - centre[0].xyz; }
