// Loops may have any number of turns.
fn report_turns(nothing: u32) {}
