// Software adapters leave every loop after its first turn once an invocation has made 65 535 turns in all, without a word. Raises a
// failure when that has happened; `nothing` is 0, which no compiler may know, or it would not count.
fn report_turns(nothing: u32) {
    var turns = 0u;
    for (var i = 0u; i < 2u + nothing; i++) { turns += 1u; }
    raise(select(FAILURE_LOOPS, 0u, turns == 2u));
}
