// No neighbours are listed.
fn check_anchor(slot: u32, fraction: Fraction) {}
