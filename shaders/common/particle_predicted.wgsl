// A particle that carries, beside its momentum, the predicted momentum that the friction sees (lambda other than 1/2).
struct Particle {
    position: vec4<u32>,
    momentum: vec4<i32>,
    predicted: vec4<i32>,
}
const FOURS: u32 = 3u; // of words

// 2 lambda - 1: the part of the opening half kick that the prediction adds.
override PREDICTION: f32;

// The rest of the word carries, within a step, what a pass leaves for the next.
fn species_of(particle: Particle) -> i32 { return particle.momentum.w & 255; }
fn friction_momentum(particle: Particle) -> Steps { return steps_of(particle.predicted); }
fn advanced_particle(position: vec4<u32>, momentum: vec4<i32>, kick: Steps) -> Particle {
    let shift = Steps(round(PREDICTION * Vector(kick)));
    return Particle(position, momentum, momentum_word(steps_of(momentum) + shift, momentum.w));
}
