// Particles ordered by cell, with the frames of each row filled in.
@group(0) @binding(2) var<storage, read_write> sorted: array<Particle>;
@group(0) @binding(4) var<storage, read_write> probes: array<u32>;
