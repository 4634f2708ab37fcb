// Roots of unity between the passes, from a table of the longest line's.
override ROOTS: u32;

// Legs of butterfly `number` of those that make a transform of `length`.
fn twisted(legs: Legs, number: u32, length: u32) -> Legs { return turned(legs, number * (ROOTS / length)); }
