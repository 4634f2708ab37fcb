// Several species: the species of a sorted particle, without the rest of it.
fn other_species(index: u32) -> i32 { return species_in(momentum_at(index)); }
