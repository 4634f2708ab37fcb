// Analyses find cells by their numbers.
@group(0) @binding(40) var<storage, read_write> reported: array<Particle>;

fn note_report(cell: Particle) { reported[cell.position.w] = cell; }
