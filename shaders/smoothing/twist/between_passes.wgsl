// Legs are multiplied by roots of unity between two passes, from a table for the longest line.

// The legs of butterfly `number` of those that make a transform of `length`.
fn twisted(legs: Legs, number: u32, length: u32) -> Legs { return turned_legs(legs, number * (ROOTS / length)); }
