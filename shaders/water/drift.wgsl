// The step of a free particle. Without gyration: rotation, kick, drift, kick, rotation, where the rotation turns
// velocities alone. With gyration: kick, gyration, kick, the exact flow of a free particle, whose path the rotation
// bends into a circle.
override GYRATES: u32;    // 1 with gyration
override CHORD_X: f32;    // units of the box fraction per velocity unit, along the velocity …
override CHORD_Y: f32;
override SAGITTA_X: f32;  // … and across it
override SAGITTA_Y: f32;

// The velocity at the report point of a step.
fn closed(velocity: vec2<i32>, kick: vec2<i32>) -> vec2<i32> {
    if (GYRATES == 1u) { return velocity + kick; }
    return turned_by_rotation(velocity + kick);
}
// Position and velocity of the next step, from the velocity at the report point.
fn opened(particle: Water, kick: vec2<i32>) -> Water {
    var next = particle;
    if (GYRATES == 1u) { next.velocity += kick; } else { next.velocity = turned_by_rotation(next.velocity) + kick; }
    let v = vec2<f32>(next.velocity);
    var path = vec2<f32>(CHORD_X, CHORD_Y) * v;
    if (GYRATES == 1u) { path += vec2<f32>(SAGITTA_X, -SAGITTA_Y) * v.yx; }
    check_motion(next.velocity);
    next.position += bitcast<vec2<u32>>(vec2<i32>(round(path)));
    if (GYRATES == 1u) { next.velocity = turned_by_rotation(next.velocity); }
    return next;
}

// The rotation of velocities in a step, by quarter turns and three shears of integers: exactly reversible, and no length
// is lost.
override QUARTER_TURNS: u32;
override TURN_TANGENT: f32; // of half the angle that is left
override TURN_SINE: f32;

fn turned_by_rotation(velocity: vec2<i32>) -> vec2<i32> {
    var v = velocity;
    if ((QUARTER_TURNS & 1u) == 1u) { v = vec2<i32>(v.y, -v.x); }
    if ((QUARTER_TURNS & 2u) == 2u) { v = -v; }
    if (TURN_SINE == 0.0) { return v; }
    v.x += i32(round(TURN_TANGENT * f32(v.y)));
    v.y -= i32(round(TURN_SINE * f32(v.x)));
    v.x += i32(round(TURN_TANGENT * f32(v.y)));
    return v;
}

// Checks what the integer state can hold.
fn check_motion(velocity: vec2<i32>) {
    // Unsigned, because the least integer is its own absolute value.
    let speed = vec2<u32>(abs(velocity));
    failures_of_motion |= select(0u, FAILURE_MOMENTUM, max(speed.x, speed.y) > u32(VELOCITY_LIMIT));
}
