// Raises a failure when the adapter has left a loop too early: software adapters leave every loop after its first turn once an
// invocation has made 65 535 turns in all, without an error. `nothing` is 0; a compiler that knew it would not count.
fn report_turns(nothing: u32) {
    var turns = 0u;
    for (var i = 0u; i < 2u + nothing; i++) { turns += 1u; }
    raise(select(FAILURE_LOOPS, 0u, turns == 2u));
}
