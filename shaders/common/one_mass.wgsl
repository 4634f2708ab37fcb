// All particles have the same mass: friction is one of momenta, which are exact.
override INVERSE_MASS: f32;
override DRIFT: f32;   // displacement in a step per unit of momentum
override KINETIC: f32; // energy per square of a unit of momentum

fn inverse_mass_of(species: i32) -> f32 { return INVERSE_MASS; }
fn drift_of(species: i32) -> f32 { return DRIFT; }
fn kinetic_of(species: i32) -> f32 { return KINETIC; }

// Whether a particle is the first of its pair. It does not matter here: neither depends on a mass, and what is added up or
// subtracted is integers, or the same either way round.
fn ordered(me: Particle, other: Particle) -> bool { return true; }
// Rate of a pair among others; rates are per mass.
fn rate_scale_of(species: i32) -> f32 { return 1.0; }
fn pair_rate(first: i32, second: i32, own: f32, of_first: f32, of_second: f32) -> f32 {
    return 2.0 * own + (of_first + of_second) * (0.5 / f32(DIMENSION));
}
// The difference of two momenta, exact in integers: odd under exchange to the last bit.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    return Vector(mine - theirs);
}
