// Cells are stored by id for analyses, with a momentum of two components.

fn note_report(cell: Particle) {
    reported[cell.position.w] = Particle(cell.position, momentum_word(steps_of(cell.momentum), cell.momentum.w));
}
