//! The `mesoscope` program.
fn main() {}
