// A particle as it is stored: position.xyz are fractions of the box, position.w the persistent id; momentum.xyz are
// integer momentum units, momentum.w the index of the species.
struct Particle {
    position: vec4<u32>,
    momentum: vec4<i32>,
}

// 2 lambda - 1: the part of the opening half kick by which the momentum is predicted that friction sees. Zero unless an
// integrator predicts one. The upper bits of momentum.w then hold what the prediction adds, three components of six
// bits with a common exponent; `src/prediction.rs` does the same.
override PREDICTION: f32;

// Within a step, the upper bits of the species' word carry what one pass leaves for the next.
fn species_in(momentum: vec4<i32>) -> i32 { return momentum.w & 255; }
fn species_of(particle: Particle) -> i32 { return species_in(particle.momentum); }

// An exponent that lets the largest component round to at most 31, and the components in its units.
fn packed_shift(shift: vec4<i32>) -> i32 {
    let size = abs(shift);
    let largest = max(max(size.x, size.y), size.z);
    let exponent = u32(max(firstLeadingBit(largest + (largest >> 5u)) - 4, 0));
    let rounded = ((shift + ((1i << exponent) >> 1u)) >> vec4<u32>(exponent)) & vec4<i32>(63);
    return i32(exponent) | (rounded.x << 5u) | (rounded.y << 11u) | (rounded.z << 17u);
}
fn friction_momentum(particle: Particle) -> Steps {
    if (PREDICTION == 0.0) { return steps_of(particle.momentum); }
    let word = particle.momentum.w;
    let exponent = vec4<u32>(extractBits(u32(word), 8u, 5u));
    let shift = vec4<i32>(extractBits(word, 13u, 6u), extractBits(word, 19u, 6u), extractBits(word, 25u, 6u), 0) << exponent;
    return steps_of(particle.momentum + shift);
}
fn advanced_particle(position: vec4<u32>, momentum: vec4<i32>, kick: Steps) -> Particle {
    if (PREDICTION == 0.0) { return Particle(position, momentum); }
    let shift = packed_shift(momentum_word(Steps(round(PREDICTION * Vector(kick))), 0));
    return Particle(position, vec4<i32>(momentum.xyz, momentum.w | (shift << 8u)));
}
