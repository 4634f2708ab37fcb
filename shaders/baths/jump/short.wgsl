// Forces in random directions for exponentially distributed times, whose autocorrelation is exponential.
override HOLD_FORCE: f32; // √α
override HOLD_TIME: f32;  // τ in half steps

fn jump_after(id: u32, jump: u32) -> Jump {
    let direction = words_of_jump(id, jump, 0u).y;
    let more = words_of_jump(id, jump, 1u);
    return Jump(HOLD_FORCE * direction_of(direction, more.y), 0.5 * HOLD_TIME * minus_two_log(centred_uniform(more.x)));
}
