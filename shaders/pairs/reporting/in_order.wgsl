// Of several ranks each leaves its particles in the order in which they are stored.
fn report_particle(row: u32, index: u32, particle: Particle) { store_particle(unframed_index(row, index), particle); }
