// Cells are stored by id for analyses, with a momentum of two components.
var<storage, read_write> reported: array<Particle>;

fn note_report(cell: Particle) {
    reported[cell.position.w] = Particle(cell.position, momentum_word(steps_of(cell.momentum), cell.momentum.w));
}
