// Particles of one species, all of which can move.
override MEASURED_SPECIES: i32;
fn is_measured(id: u32) -> bool { return id < PARTICLES && species_in(stored_momentum(id)) == MEASURED_SPECIES; }
