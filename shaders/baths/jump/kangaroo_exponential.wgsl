// The kangaroo process with exponentially distributed times of mean ε/φ, φ = √U.
override HOLD_FORCE: f32; // √α
override HOLD_TIME: f32;  // ε in half steps

fn jump_after(id: u32, jump: u32) -> Jump {
    let words = words_of_jump(id, jump, 0u);
    let more = words_of_jump(id, jump, 1u);
    let time = 0.5 * minus_two_log(centred_uniform(more.x)) * HOLD_TIME / sqrt(uniform_of_jump(words.x));
    return Jump(HOLD_FORCE * direction_of(words.y, more.y), time);
}
