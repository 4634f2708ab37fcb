// There is no rotation in this scene.
fn turned(velocity: vec2<i32>) -> vec2<i32> { return velocity; }
