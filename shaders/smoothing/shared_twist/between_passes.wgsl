// Legs are multiplied by roots of unity between two passes, from a table for the longest line.

// The legs of a lane's part of butterfly `number` of those that make a transform of `length`.
fn first_twisted(legs: FirstLegs, column: u32, number: u32, length: u32) -> FirstLegs {
    return first_turned(legs, column, number * (ROOTS / length));
}
