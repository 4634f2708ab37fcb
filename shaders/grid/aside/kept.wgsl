// Particles in their old order, from where they are stored in the new one.
fn keep_aside(index: u32) { sort_particle(index, stored_particle(index)); }
