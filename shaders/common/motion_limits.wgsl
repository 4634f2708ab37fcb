// What the integer state can hold. Failures are gathered and raised once, when all particles of an invocation are done.
var<private> failures_of_motion: u32;

fn check_motion(velocity: vec2<i32>, path: vec2<f32>) {
    const VELOCITY_LIMIT: i32 = 1073741824; // 2^30
    const PATH_LIMIT: f32 = 2147483520.0;   // half the box
    let speed = max(abs(velocity.x), abs(velocity.y));
    let length = max(abs(path.x), abs(path.y));
    failures_of_motion |= select(0u, FAILURE_MOMENTUM, speed > VELOCITY_LIMIT) |
        select(0u, FAILURE_DISPLACEMENT, length > PATH_LIMIT);
}
