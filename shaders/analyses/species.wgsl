// Measurements of one species.

// == analyses/measured/of_species
// Particles of one species, all of which can move.
override MEASURED_SPECIES: i32;
fn is_measured(id: u32) -> bool { return id < PARTICLES && species_in(stored_momentum(id)) == MEASURED_SPECIES; }

// == analyses/in_layers/of_species
// Particles of one species.
override PROFILED_SPECIES: i32;
fn is_in_layers(id: u32) -> bool { return id < PARTICLES && species_in(stored_momentum(id)) == PROFILED_SPECIES; }

// == analyses/of_wave/species
// The particles of the species that the wave has.
fn is_of_wave(id: u32, species: i32) -> bool { return species_in(stored_momentum(id)) == species; }
