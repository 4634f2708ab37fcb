// No coloured noise.
struct Held { closing: Steps, opening: Steps }
fn advance_hold(id: u32) -> Held { return Held(Steps(0), Steps(0)); }
fn closing_of_hold(id: u32) -> Steps { return Steps(0); }
