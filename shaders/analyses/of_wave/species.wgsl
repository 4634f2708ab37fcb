// The particles of the species that the wave has.
fn is_of_wave(id: u32, species: i32) -> bool { return species_in(stored_momentum(id)) == species; }
