// Of several ranks: as many as are stored, without those that were forgotten.
fn is_stored(index: u32) -> bool { return index < stored && stored_position(index).w != NOBODY; }
