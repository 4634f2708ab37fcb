// No neighbours are listed.
fn check_anchor(slot: u32, fraction: Fraction) {}
fn note_anchor(slot: u32, position: vec4<u32>) {}
