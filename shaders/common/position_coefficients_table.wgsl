// Several species: position baths follow the pairs of species in their table.
fn position_entry(species: i32) -> vec4<f32> { return coefficient_entry(SPECIES * SPECIES + u32(species)); }
fn position_response(species: i32) -> f32 { return position_entry(species).x; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).y; }
fn position_energy(species: i32) -> f32 { return position_entry(species).z; }
