// As an invocation has found it for all of its pairs.
fn shift_here() -> u32 { return shift_of_visit; }
