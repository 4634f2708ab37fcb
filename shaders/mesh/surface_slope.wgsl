// The half kick of a particle by the slope of the surface, from the polynomial that the splines make of it in a cell.
override KICK_X: f32; // velocity units per slope in cells
override KICK_Y: f32;
override VELOCITY_LIMIT: i32; // beyond which a velocity, or the displacement in a step, leaves the range of its integers

// Failures are gathered and raised once, when all particles of an invocation are done.
var<private> failures_of_motion: u32;

// The coefficients of xᵃ yᵇ in a cell, from the surface on its nodes.
fn surface_of(nodes: Square) -> Square { return transpose(SPLINE) * nodes * SPLINE; }
fn surface_in_cell(column: u32, row: u32) -> Square { return surface_of(nodes_of(column, row)); }
fn half_kick(polynomial: Square, x: f32, y: f32) -> vec2<i32> {
    return vec2<i32>(round(vec2<f32>(KICK_X, KICK_Y) * gradient(polynomial, x, y)));
}

// Checks what the integer state can hold.
fn check_motion(velocity: vec2<i32>) {
    // Unsigned, because the least integer is its own absolute value.
    let speed = vec2<u32>(abs(velocity));
    failures_of_motion |= select(0u, FAILURE_MOMENTUM, max(speed.x, speed.y) > u32(VELOCITY_LIMIT));
}

// The rotation of velocities in a step, by quarter turns and three shears of integers: exactly reversible, and no length is lost.
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

// The drift: without gyration rotation, kick, drift, kick, rotation, where the rotation turns velocities alone; else kick, gyration,
// kick, the exact flow of a free particle, whose path the rotation bends into a circle.
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

// Slot mesh/surface: `surface_at` is what drives the particles on a node, `depth_in_cell` the depth on the node of a cell,
// given the surface on the nodes under its splines. Default: the smoothed depth. The plan chooses `bath` if there is one.
fn surface_at(node: u32) -> f32 { return depths[node]; }
fn depth_in_cell(cell: u32, nodes: Square) -> f32 { return nodes[NODES_BEFORE][NODES_BEFORE]; }
