// What the integer state can hold. Failures are gathered and raised once, when all particles of an invocation are done.
override VELOCITY_LIMIT: i32; // beyond which a velocity, or the way of a step, leaves the range of its integers
var<private> failures_of_motion: u32;

fn check_motion(velocity: vec2<i32>) {
    // Unsigned, for the least integer is its own absolute value.
    let speed = vec2<u32>(abs(velocity));
    failures_of_motion |= select(0u, FAILURE_MOMENTUM, max(speed.x, speed.y) > u32(VELOCITY_LIMIT));
}
