// The kangaroo process: a force in a random direction for the time ε/φ, φ = √U, so that its autocorrelation has an
// algebraic tail.
override HOLD_FORCE: f32; // √α
override HOLD_TIME: f32;  // ε in half steps

fn jump_after(id: u32, jump: u32) -> Jump {
    let words = words_of_jump(id, jump, 0u);
    let direction = direction_of(words.y, words_of_jump(id, jump, 1u).y);
    return Jump(HOLD_FORCE * direction, HOLD_TIME / sqrt(uniform_of_jump(words.x)));
}
