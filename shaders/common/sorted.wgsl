// Particles ordered by cell; where rows have frames, with those filled in.
@group(0) @binding(2) var<storage, read_write> sorted: array<Particle>;
