// No analysis asks for cells by their numbers.
fn note_report(cell: Particle) {}
