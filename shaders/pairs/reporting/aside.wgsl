// Particles go on from where they are stored: a report has copies, by id.
fn report_particle(row: u32, index: u32, particle: Particle) { reported[particle.position.w] = particle; }
