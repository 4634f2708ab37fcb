// A particle as it is stored: position.xyz are fractions of the box, position.w the persistent id; momentum.xyz are
// integer momentum units, momentum.w the index of the species.
struct Particle {
    position: vec4<u32>,
    momentum: vec4<i32>,
}

// Within a step, the upper bits of the species' word carry what one pass leaves for the next.
fn species_in(momentum: vec4<i32>) -> i32 { return momentum.w & 255; }
fn species_of(particle: Particle) -> i32 { return species_in(particle.momentum); }
fn friction_momentum(particle: Particle) -> Steps { return steps_of(particle.momentum); }
fn advanced_particle(position: vec4<u32>, momentum: vec4<i32>, kick: Steps) -> Particle {
    return Particle(position, momentum);
}
