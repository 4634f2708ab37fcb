// Particles ordered by cell, in a buffer; where rows have frames, with those filled in.
var<storage, read_write> sorted: array<Particle>;

fn particle_at(index: u32) -> Particle { return sorted[index]; }
fn position_at(index: u32) -> vec4<u32> { return sorted[index].position; }
fn momentum_at(index: u32) -> vec4<i32> { return sorted[index].momentum; }
fn keep_momentum(index: u32, word: vec4<i32>) { sorted[index].momentum = word; }
fn sort_particle(index: u32, particle: Particle) { sorted[index] = particle; }
