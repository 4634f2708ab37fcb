// What the integer state can hold. Failures are gathered and raised once, when all particles of an invocation are done.
override VELOCITY_LIMIT: i32; // beyond which a velocity, or the way of a step, leaves the range of its integers
var<private> failures_of_motion: u32;

fn check_motion(velocity: vec2<i32>) {
    let speed = max(abs(velocity.x), abs(velocity.y));
    failures_of_motion |= select(0u, FAILURE_MOMENTUM, speed > VELOCITY_LIMIT);
}
