// Kick, gyration, kick: the exact flow of a free particle, whose path the rotation bends into a circle.
override CHORD_X: f32;    // units of the box fraction per velocity unit, along the velocity …
override CHORD_Y: f32;
override SAGITTA_X: f32;  // … and across it
override SAGITTA_Y: f32;

// The velocity at the report point of a step.
fn closed(velocity: vec2<i32>, kick: vec2<i32>) -> vec2<i32> { return velocity + kick; }
// Position and velocity of the next step, from the velocity at the report point.
fn opened(particle: Water, kick: vec2<i32>) -> Water {
    var next = particle;
    next.velocity += kick;
    let v = vec2<f32>(next.velocity);
    let path = vec2<f32>(CHORD_X, CHORD_Y) * v + vec2<f32>(SAGITTA_X, -SAGITTA_Y) * v.yx;
    check_motion(next.velocity);
    next.position += bitcast<vec2<u32>>(vec2<i32>(round(path)));
    next.velocity = turned_by_rotation(next.velocity);
    return next;
}
