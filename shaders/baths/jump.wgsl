// A random force that is constant for random times: its next value and the half steps that it lasts.
override HOLD_PROCESS: u32;       // of the scene: 2 is `short`
const HOLD_KANGAROO: u32 = 0u;
const HOLD_KANGAROO_EXPONENTIAL: u32 = 1u;
const HOLD_LITERAL: u32 = 3u;
override HOLD_FORCE: f32;         // √α
override HOLD_TIME: f32;          // ε, or τ, in half steps
override HOLD_TURNS: f32 = 0.0;   // 1/(2π√ε)

// Slot space/dimension: the direction at an angle, in two dimensions. Default: a process that needs one is of two
// dimensions.
fn direction_at(turns: f32) -> Vector { return Vector(0.0); }

fn jump_after(id: u32, jump: u32) -> Jump {
    let words = words_of_jump(id, jump, 0u);
    // The process as Borreguero, Ellero and Adams print it, equations (8) and (9): angle φ/√ε, time ε/φ, both from
    // one φ = U.
    if (HOLD_PROCESS == HOLD_LITERAL) {
        let phi = uniform_of_jump(words.x);
        return Jump(HOLD_FORCE * direction_at(phi * HOLD_TURNS), HOLD_TIME / phi);
    }
    let more = words_of_jump(id, jump, 1u);
    let force = HOLD_FORCE * direction_of(words.y, more.y);
    // The kangaroo process: for the time ε/φ, φ = √U, so that the autocorrelation has an algebraic tail.
    if (HOLD_PROCESS == HOLD_KANGAROO) { return Jump(force, HOLD_TIME / sqrt(uniform_of_jump(words.x))); }
    let exponential = 0.5 * minus_two_log(centred_uniform(more.x));
    // Exponentially distributed times of mean ε/φ.
    if (HOLD_PROCESS == HOLD_KANGAROO_EXPONENTIAL) {
        return Jump(force, exponential * HOLD_TIME / sqrt(uniform_of_jump(words.x)));
    }
    // Exponentially distributed times of mean τ: the autocorrelation is exponential.
    return Jump(force, exponential * HOLD_TIME);
}
