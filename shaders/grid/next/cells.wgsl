// The next step orders particles by cell: each is counted into its own.
fn note_place(slot: u32, place: Fraction) { count_into_cell(slot, place); }
