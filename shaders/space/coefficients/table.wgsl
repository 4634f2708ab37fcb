// Several species: a table of pairs of species (row: this particle's), in integer momentum units. Each entry also holds the
// inverse mass of the column's species.
override SPECIES: u32;

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let entry = coefficient_entry(u32(a) * SPECIES + u32(b));
    return Coefficients(entry.x, entry.y, entry.z);
}

// The species of a sorted particle, without the rest of it.
fn other_species(index: u32) -> i32 { return species_in(momentum_at(index)); }

// The position baths of the species follow the pairs in the table.
fn position_entry(species: i32) -> vec4<f32> { return coefficient_entry(SPECIES * SPECIES + u32(species)); }
fn position_response(species: i32) -> f32 { return position_entry(species).x; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).y; }
fn position_energy(species: i32) -> f32 { return position_entry(species).z; }
