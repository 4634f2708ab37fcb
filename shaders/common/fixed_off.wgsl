// Every particle can move.
fn is_fixed(species: i32) -> bool { return false; }
