// Particles of one species.
override PROFILED_SPECIES: i32;
fn is_in_layers(id: u32) -> bool { return id < PARTICLES && species_in(stored_momentum(id)) == PROFILED_SPECIES; }
