// Particles ordered by cell.
@group(0) @binding(2) var<storage, read_write> sorted: array<Particle>;
