// Forces in random directions for exponentially distributed times, whose autocorrelation is exponential.
override HOLD_FORCE: f32; // √α
override HOLD_TIME: f32;  // τ in half steps

fn jump_of(id: u32, jump: u32) -> Jump {
    let direction = words_of_jump(id, jump, 0u).y;
    let more = words_of_jump(id, jump, 1u);
    return Jump(HOLD_FORCE * direction_of(direction, more.y), -HOLD_TIME * log(uniform_of_jump(more.x)));
}
