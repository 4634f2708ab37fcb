// Cells at the temperature of the scene have no energy of their own.
fn check_energy(cell: Particle) {}
