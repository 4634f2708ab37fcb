// What the integer state can hold.
fn check_motion(velocity: vec2<i32>, path: vec2<f32>) {
    const VELOCITY_LIMIT: i32 = 1073741824; // 2^30
    const PATH_LIMIT: f32 = 2147483520.0;   // half the box
    let fast = any(velocity > vec2<i32>(VELOCITY_LIMIT)) || any(velocity < vec2<i32>(-VELOCITY_LIMIT));
    let far = any(abs(path) > vec2<f32>(PATH_LIMIT));
    raise(select(0u, FAILURE_MOMENTUM, fast) | select(0u, FAILURE_DISPLACEMENT, far));
}
