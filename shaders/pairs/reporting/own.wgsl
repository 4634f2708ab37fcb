// Of several ranks each reports its own particles, in the order in which they are stored.
fn is_reported(position: vec4<u32>) -> bool { return lies_in(OWN, position); }
fn reported_place(row: u32, index: u32, id: u32) -> u32 { return unframed_index(row, index); }
