// Particles of species without an inverse mass are held where they are.
fn is_fixed(species: i32) -> bool { return inverse_mass_of(species) == 0.0; }
