// The process as Borreguero, Ellero and Adams print it, equations (8) and (9): angle φ/√ε and time ε/φ from one φ = U.
override HOLD_FORCE: f32; // √α
override HOLD_TIME: f32;  // ε in half steps
override HOLD_TURNS: f32; // 1/(2π√ε)

fn jump_after(id: u32, jump: u32) -> Jump {
    let phi = uniform_of_jump(words_of_jump(id, jump, 0u).x);
    return Jump(HOLD_FORCE * direction_at(phi * HOLD_TURNS), HOLD_TIME / phi);
}
