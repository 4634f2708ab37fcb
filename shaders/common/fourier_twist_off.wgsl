// First pass along a line: no roots of unity yet.
fn twisted(legs: Legs, number: u32, length: u32) -> Legs { return legs; }
