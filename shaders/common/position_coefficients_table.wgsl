// Several species: position baths follow the pairs of species in their table.
fn position_entry(species: i32) -> PairCoefficients { return coefficients[SPECIES * SPECIES + u32(species)]; }
fn position_response(species: i32) -> f32 { return position_entry(species).repulsion; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).friction; }
fn position_energy(species: i32) -> f32 { return position_entry(species).noise; }
