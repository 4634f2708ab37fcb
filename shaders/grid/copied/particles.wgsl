// Particles are copied as kernels know them, from wherever they are stored.
alias Copied = Particle;

fn copied(index: u32) -> Copied { return stored_particle(index); }
fn copied_position(particle: Copied) -> vec4<u32> { return particle.position; }
fn copied_momentum(particle: Copied) -> vec4<u32> { return bitcast<vec4<u32>>(particle.momentum); }
