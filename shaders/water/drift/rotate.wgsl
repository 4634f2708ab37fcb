// Rotation, kick, drift, kick, rotation: the rotation turns velocities alone.
override CHORD_X: f32;    // units of the box fraction per velocity unit
override CHORD_Y: f32;

// The velocity at the report point of a step.
fn closed(velocity: vec2<i32>, kick: vec2<i32>) -> vec2<i32> { return turned_by_rotation(velocity + kick); }
// Position and velocity of the next step, from the velocity at the report point.
fn opened(particle: Water, kick: vec2<i32>) -> Water {
    var next = particle;
    next.velocity = turned_by_rotation(next.velocity) + kick;
    let path = vec2<f32>(CHORD_X, CHORD_Y) * vec2<f32>(next.velocity);
    check_motion(next.velocity);
    next.position += bitcast<vec2<u32>>(vec2<i32>(round(path)));
    return next;
}
