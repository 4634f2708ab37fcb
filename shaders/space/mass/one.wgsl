// All particles have the same mass: friction is one of momenta, which are exact.
override INVERSE_MASS: f32;
override DRIFT: f32;   // displacement in a step per unit of momentum

fn inverse_mass_of(species: i32) -> f32 { return INVERSE_MASS; }
fn drift_of(species: i32) -> f32 { return DRIFT; }
fn kinetic_of(species: i32) -> f32 { return KINETIC; }

// Whether what belongs to this particle is computed before what belongs to the other one. At either end it is: there is no mass in
// it that would round differently.
fn mine_first(me: Particle, other: Particle) -> bool { return true; }
// Rate of a pair among others, from what its particles feel from these; rates are per mass.
fn rate_scale_of(species: i32) -> f32 { return 1.0; }
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    return 2.0 * own + (mine + theirs) * (0.5 / f32(DIMENSION));
}
// The difference of two momenta, exact in integers: odd under exchange to the last bit.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    return Vector(mine - theirs);
}
